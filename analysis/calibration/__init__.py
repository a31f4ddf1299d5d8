"""How often verdicts are wrong on a machine, from streams of rounds whose true ratios are known.

`streams.py` reads them, `studies.py` makes small studies of a stream by Carom's rule and `usual_ways.py` by
the ways that are usual, `bounds.py` has exact bounds of a share, `tables.py` counts, and `result.py` shows
what came of it.
"""
