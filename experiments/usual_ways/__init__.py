"""`carom compare` beside what people use today: the same pairs of programs, on the same machine, in turn."""
