"""Commands compared with one another, in a folder that is gone afterwards."""
