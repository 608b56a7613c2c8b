// Who wants to know of a change.

export class Listeners<Arguments extends unknown[] = []> {
  private list: { act: (...values: Arguments) => void; place: Node }[] = [];

  /** `place`: where it shows something; a listener goes with what leaves the page. */
  add(act: (...values: Arguments) => void, place: Node = document): void {
    this.list.push({ act, place });
  }

  call(...values: Arguments): void {
    this.list = this.list.filter(({ place }) => place.isConnected);
    for (const { act } of this.list) act(...values);
  }
}
