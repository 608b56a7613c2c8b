"""All mechanisms, by family."""

import contact
import gimbals
import pulses
import singular
import turns


def cases():
    for family in (singular, gimbals, contact, pulses, turns):
        yield from family.cases()
