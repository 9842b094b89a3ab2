"""Tasks that run: the run of a program, those that the sites of an ecology keep, and what became of each."""
