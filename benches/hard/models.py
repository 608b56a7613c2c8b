"""All hard mechanisms, by family."""

import light
import own
import rank
import thin


def cases():
    for family in (light, rank, thin, own):
        yield from family.cases()
