"""Pictures of the site that need a browser, a solved sensor or a minute, and are therefore kept in git.

``make pictures`` draws them. Each module can be run alone: ``PYTHONPATH=docs/_ext python -m pictures.NAME``.
"""
