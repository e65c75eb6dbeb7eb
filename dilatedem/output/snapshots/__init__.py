"""Snapshots for ParaView: `ice`, `structures` that move, floes that are `bent`; each a `collection` of files that `vtu` writes."""
