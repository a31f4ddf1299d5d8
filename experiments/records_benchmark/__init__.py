"""How long it takes to read folders of made-up records: what grows with what is there, and what does not."""
