"""A hard mechanism: its model, what is known of it, and the sizes by which round-off is judged."""

import dataclasses


def value(item):
    """A value as TOML."""
    if isinstance(item, bool):
        return "true" if item else "false"
    if isinstance(item, str):
        return f'"{item}"'
    if isinstance(item, dict):
        return "{ " + ", ".join(f"{key} = {value(part)}" for key, part in item.items()) + " }"
    if hasattr(item, "tolist"):
        return value(item.tolist())
    if isinstance(item, (list, tuple)):
        return "[" + ", ".join(value(part) for part in item) + "]"
    return repr(float(item)) if isinstance(item, float) else str(int(item))


def toml(model):
    """A model as the text of its file: plain keys first, then a table for each entry of each kind."""
    lines = [f"{key} = {value(item)}" for key, item in model.items() if not isinstance(item, dict)]
    for kind, entries in model.items():
        if not isinstance(entries, dict):
            continue
        whole = {key: item for key, item in entries.items() if not isinstance(item, dict)}
        if whole:
            lines += ["", f"[{kind}]", *(f"{key} = {value(item)}" for key, item in whole.items())]
        for name, entry in entries.items():
            if isinstance(entry, dict):
                lines += ["", f"[{kind}.{name}]", *(f"{key} = {value(item)}" for key, item in entry.items())]
    return "\n".join(lines) + "\n"


@dataclasses.dataclass
class Case:
    """A mechanism with a step and an end; without a truth only what the methods promise is judged."""

    name: str
    model: object
    step: float = 0.01
    end: float = 0.2
    # Places at a list of times, one row of numbers each, and the columns of the trajectory that are to be so.
    truth: object = None
    columns: tuple = ()
    # Sizes of the mechanism: length, m; energy, J; speed, m/s; mass, kg, times gravity; distance from the origin, m.
    length: float = 1.0
    energy: float = 1.0
    speed: float = 4.0
    weight: float = 0.0
    # Rate of the motion, 1/s, where it is not speed over length; the heaviest mass over the lightest.
    rate: float = 0.0
    ratio: float = 1.0
    offset: float = 0.0
    # Error below which nothing is said about the order, m or rad.
    floor: float = 1e-9
    # Keys of the summary that are known.
    expect: dict = dataclasses.field(default_factory=dict)
    # Whether `holonom check` is judged and nothing is run.
    check: bool = False

    def pace(self):
        return self.rate or self.speed / self.length

    def text(self):
        """The model's file, or the name of an example."""
        return self.model if isinstance(self.model, str) else toml(self.model)


def plane(**entries):
    """A model in the plane under gravity."""
    return {"plane": "xy", "gravity": [0, -9.81], **entries}


def space(**entries):
    """A model in space under gravity along z."""
    return {"gravity": [0, 0, -9.81], **entries}


def rod(first, second):
    return {"type": "distance", "between": [first, second]}


def revolute(first, second, at, axis=None):
    return {"type": "revolute", "between": [first, second], "at": list(at), **({} if axis is None else {"axis": list(axis)})}


def with_reactions(model):
    return {**model, "output": {"reactions": True}}
