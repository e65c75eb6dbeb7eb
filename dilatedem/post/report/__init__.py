"""report.html: its parts, a file each, and the pages that they make, of a run and of a sweep."""
