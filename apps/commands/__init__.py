"""The command line: what takes a chain in ``chains``, many cases in ``batches``, all in ``line``.

Every file imports only the standard library, typer and its neighbours at its top, so that
``--help`` answers at once. A job imports what it needs when it runs.
"""
