"""Cars with a VESC as their motor controller, such as those of F1TENTH."""
