"""``python -m meshgrow`` is the program ``meshgrow``."""

from ._program import main

main()
