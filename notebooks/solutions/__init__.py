"""The expected answers to the tasks of the lessons, one module for each notebook.

A lesson compares the answers of its reader with these. The copies that ``make lessons`` writes
contain no answer, so whoever wants to see one has to open a file of this folder on purpose.
"""
