"""Interfaces of lbr_fri_idl: commands and states of KUKA LBR robots."""
