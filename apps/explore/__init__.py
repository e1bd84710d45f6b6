"""The page in the browser, ``crazybilliards explore``: its files in ``page``, server and theory."""
