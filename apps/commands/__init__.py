"""The command line: its entry is ``line``, its commands lie in three files.

Every file imports only the standard library, typer and its neighbours at its top, so that
``--help`` answers at once. A job imports what it needs when it runs.
"""
