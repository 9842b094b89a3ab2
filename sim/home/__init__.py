"""The apartment as its Turtle describes it: rooms, walls and places, goals that name a place, ways that lead there."""
