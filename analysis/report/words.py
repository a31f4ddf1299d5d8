"""How the report says in sentences what was found: facts in, words of `sentences.jinja` out."""

from analysis.figures.captions import teller

tell = teller("analysis.report", "sentences.jinja")
