"""Makes what is generated under `docs/`: the pages of `docs/reference/` from parsers and schemas, and the
figures and measured tables that `docs/figures/figures.toml` lists. `make docs` calls it.

It may use every package, none of which may use it.
"""
