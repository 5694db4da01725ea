"""JSON that a request holds."""

import json
from typing import Any

from starlette.requests import Request

from pneutouch.errors import InputError


async def json_body(request: Request, what: str) -> Any:
    """The document in a body. Raises InputError, which names it by ``what``, if there is none."""
    try:
        content = json.loads(await request.body())
        # JSON can escape halves of surrogate pairs; such a text has no bytes, so that no answer could repeat it.
        json.dumps(content, ensure_ascii=False).encode()
    except (ValueError, RecursionError):
        raise InputError(f"the {what} is not JSON") from None
    return content
