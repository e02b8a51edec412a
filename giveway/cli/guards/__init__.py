"""Guards: files are checked, or opened in another process, before a command trusts them."""
