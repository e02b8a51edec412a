"""``python -m giveway``: the command line."""

from giveway.cli import main

main()
