"""All mechanisms, by family."""

import contact
import gimbals
import pulses
import singular


def cases():
    for family in (singular, gimbals, contact, pulses):
        yield from family.cases()
