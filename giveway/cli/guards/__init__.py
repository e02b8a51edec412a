"""Guards: files are checked, or opened in a process of their own, before a command trusts them."""
