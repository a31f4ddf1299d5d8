"""From a question (`questions/*.toml`) and a site (`sites/*.toml`) to what is to be measured.

Scenes at a scale, points, and their order within blocks. Measures nothing. Uses `support`.
"""
