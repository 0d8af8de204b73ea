"""What mkdocs runs: it makes the language `fdc` known."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent))
from fdc_lexer import register  # noqa: E402

register()
