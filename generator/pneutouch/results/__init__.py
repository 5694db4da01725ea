"""The one typed tree of what is computed: frozen records in boundary units, of which every document is a dump."""
