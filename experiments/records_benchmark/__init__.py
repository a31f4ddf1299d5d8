"""How long it takes to read results folders of made-up records: what grows with what is there, and what not."""
