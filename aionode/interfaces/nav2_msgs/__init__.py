"""Interfaces of nav2_msgs: navigation goals, costmaps, behavior trees and docking of Nav2."""
