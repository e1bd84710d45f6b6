"""The command line: one file per subcommand, `line` puts them together.

Every file imports only the standard library, typer and its neighbours at its top, so that
``--help`` answers at once. A job imports what it needs when it runs.
"""
