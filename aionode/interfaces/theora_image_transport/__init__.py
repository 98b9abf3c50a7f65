"""Interfaces of theora_image_transport: images as packets of Theora."""
