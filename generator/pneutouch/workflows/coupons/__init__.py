"""Coupons: what a lab prints, measures, and puts into profiles of its own."""
