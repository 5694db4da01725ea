"""Sections of docs/accuracy.md: text and figures from what the benchmarks measured."""
