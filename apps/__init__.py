"""What a user starts: the command line in ``commands``, the page in the browser in ``explore``."""
