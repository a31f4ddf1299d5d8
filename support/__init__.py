"""What both `experiments` and `analysis` use, and what knows of neither: a mistake in one line, files that
are whole or not there, what a record is, the command line, where Carom is, the words that pass between them.
"""
