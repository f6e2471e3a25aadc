"""What programs here say when something is wrong: one sentence with a remedy."""


class RenderError(Exception):
    """A problem the user can solve; the text is one sentence saying how."""


def tidy(message):
    """Return a message as one line without a full stop at its end."""
    return " ".join(str(message).split()).rstrip(".") or "no message"


def abridged(tags):
    """Return a short text for a list of tags."""
    shown = ", ".join(map(str, tags[:12]))
    return shown + (", ..." if len(tags) > 12 else "") or "none"
