"""Which families the search was tuned on, and which are held out.

On the sets `choosing` its ideas and thresholds were chosen. The others are held out: `reporting` were only measured,
and `unseen` were made after the search had been changed. Each further pair of sets was made once the search had been
changed on those before.
"""

from __future__ import annotations

from collections.abc import Mapping

from benchmarks.search.families.arithmetic import circuit, factors, parity, sums
from benchmarks.search.families.coverage import (
    couples,
    cover,
    fields,
    relay_chain,
    tiling,
    trios,
    triples,
    trominoes,
    watched,
)
from benchmarks.search.families.graphs import coloured_parameters, colouring, cycles, frequencies, tour, tree
from benchmarks.search.families.installations import (
    beds,
    bins,
    building,
    cabling,
    capacity,
    charging,
    licences,
    machines,
    magazine,
    redundant,
    shifts,
    voters,
    zones,
)
from benchmarks.search.families.puzzles import (
    crossword,
    domination,
    knights,
    langford,
    latin,
    latin_parameters,
    magic,
    packing,
    pigeonholes,
    queens,
    tiles,
)
from benchmarks.search.families.random_relations import (
    agreements,
    binary,
    dumbbell,
    grid,
    ladder,
    plant,
    planted,
    quorum,
    regular,
    ring,
)
from benchmarks.search.families.rosters import (
    crew,
    duties,
    hours,
    missions,
    nurses,
    relief,
    squads,
    teams,
    timetable,
    workshop,
)
from benchmarks.search.families.tasks import convoy, depot, fusion, museum, orchard, patrol, rooms, theatres
from benchmarks.search.families.wiring import Family

SETS: Mapping[str, Mapping[str, Family]] = {
    "choosing": {
        "grid": (
            ("8 x 8, 20 candidates, 12 signals", lambda seed: grid(8, 20, 12, seed)),
            ("8 x 8, 50 candidates, 12 signals", lambda seed: grid(8, 50, 12, seed, 3)),
            ("8 x 8, 100 candidates, 12 signals", lambda seed: grid(8, 100, 12, seed, 3)),
        ),
        "pigeonholes": (
            ("10 in 9", lambda seed: pigeonholes(10, 9, seed)),
            ("11 in 10", lambda seed: pigeonholes(11, 10, seed)),
            ("20 in 20", lambda seed: pigeonholes(20, 20, seed)),
            ("16 in 16, each takes to half", lambda seed: pigeonholes(16, 16, seed, 0.4)),
        ),
        "ring": (
            ("20 roles of 2", lambda seed: ring(20, 2, 12, 6, seed)),
            ("40 roles of 2", lambda seed: ring(40, 2, 12, 6, seed)),
            ("100 roles of 3", lambda seed: ring(100, 3, 12, 8, seed)),
        ),
        "Latin square": (
            ("8, 42 % open", lambda seed: latin(8, 0.42, seed)),
            ("12, 42 % open", lambda seed: latin(12, 0.42, seed)),
            ("15, 42 % open", lambda seed: latin(15, 0.42, seed)),
        ),
        "colouring": (("60 nodes, 4 colours", lambda seed: colouring(60, 4, 8.4, seed)),),
        "tour": (("16 places", lambda seed: tour(16, 4.0, seed)), ("24 places", lambda seed: tour(24, 4.0, seed))),
    },
    "reporting": {
        "tiles": (
            ("10 x 10, 12 candidates, 3 signals", lambda seed: tiles(10, 12, 3, seed)),
            ("18 x 18, 14 candidates, 4 signals", lambda seed: tiles(18, 14, 4, seed)),
        ),
        "queens": (("16", lambda seed: queens(16, seed, 4)), ("24", lambda seed: queens(24, seed, 6))),
        "dumbbell": (
            ("30 roles twice", lambda seed: dumbbell(30, 10, 4, 6, seed)),
            ("40 roles twice", lambda seed: dumbbell(40, 14, 3, 10, seed)),
        ),
        "pairs": (
            ("25 roles of 8", lambda seed: binary(25, 8, 100, 0.35, seed)),
            ("40 roles of 8", lambda seed: binary(40, 8, 200, 0.32, seed)),
        ),
        "cover": (
            ("9 of 40 stations", lambda seed: cover(60, 40, 9, 0.2, seed)),
            ("12 of 60 stations", lambda seed: cover(100, 60, 12, 0.2, seed)),
        ),
        "parity": (
            ("24 checks", lambda seed: parity(24, 4, seed)),
            ("80 checks", lambda seed: parity(80, 4, seed)),
        ),
        "crew": (
            ("25 roles, 27 people", lambda seed: crew(25, 27, 9, 0.4, seed)),
            ("40 roles, 43 people", lambda seed: crew(40, 43, 12, 0.4, seed)),
        ),
        "Langford": (("8", lambda seed: langford(8, seed)), ("11", lambda seed: langford(11, seed))),
    },
    "unseen": {
        "frequencies": (
            ("40 radios, 10 channels", lambda seed: frequencies(40, 10, 0.3, seed)),
            ("80 radios, 14 channels", lambda seed: frequencies(80, 14, 0.25, seed)),
        ),
        "plant": (
            ("5 layers of 4 roles of 2", lambda seed: plant(5, 4, 2, 12, 7, seed)),
            ("10 layers of 6 roles of 2", lambda seed: plant(10, 6, 2, 16, 8, seed)),
        ),
        "agreements": (
            ("30 roles, 8 parameters", lambda seed: agreements(30, 8, 8, 8, 0.4, seed)),
            ("60 roles, 12 parameters", lambda seed: agreements(60, 8, 12, 10, 0.4, seed)),
        ),
    },
    "choosing later": {
        "relay chain": (
            ("8 hops, 60 relays", lambda seed: relay_chain(8, 60, 0.2, seed)),
            ("14 hops, 100 relays", lambda seed: relay_chain(14, 100, 0.16, seed)),
        ),
        "missions": (
            ("9 of 50 robots, 4 of 24 chargers", lambda seed: missions(50, 9, 24, 4, 24, seed)),
            ("12 of 80 robots, 6 of 40 chargers", lambda seed: missions(80, 12, 40, 6, 36, seed)),
        ),
        "relief": (("12 shifts of 5 of 100", lambda seed: relief(12, 5, 100, 4, seed)),),
        "coloured parameters": (
            ("20 nodes, 3 colours", lambda seed: coloured_parameters(20, 3, 4.2, seed)),
            ("40 nodes, 4 colours", lambda seed: coloured_parameters(40, 4, 8.0, seed)),
        ),
    },
    "reporting later": {
        "domination": (
            ("12 on 7 x 7", lambda seed: domination(7, 12, seed)),
            ("16 on 8 x 8", lambda seed: domination(8, 16, seed)),
        ),
        "sums": (("16 checks", lambda seed: sums(16, 4, seed)), ("40 checks", lambda seed: sums(40, 4, seed))),
        "Latin by parameters": (
            ("6, half open", lambda seed: latin_parameters(6, 0.5, seed)),
            ("8, 45 % open", lambda seed: latin_parameters(8, 0.45, seed)),
        ),
        "crossword": (
            ("4 x 4, 100 words", lambda seed: crossword(4, 100, 6, seed)),
            ("5 x 5, 300 words", lambda seed: crossword(5, 300, 5, seed)),
        ),
    },
    "choosing last": {
        "knights": (
            ("10 on 7 x 7", lambda seed: knights(7, 10, seed)),
            ("12 on 8 x 8", lambda seed: knights(8, 12, seed)),
        ),
        "teams": (
            ("6 of 4", lambda seed: teams(6, 4, 32, 12, 9, seed)),
            ("10 of 4", lambda seed: teams(10, 4, 48, 14, 9, seed)),
        ),
        "circuit": (
            ("120 gates", lambda seed: circuit(20, 120, 12, seed)),
            ("300 gates", lambda seed: circuit(30, 300, 24, seed)),
        ),
        "quorum": (
            ("30 roles", lambda seed: quorum(30, 6, 14, 4, seed)),
            ("60 roles", lambda seed: quorum(60, 8, 18, 4, seed)),
        ),
    },
    "reporting last": {
        "fields": (
            ("7 and 6 of 40", lambda seed: fields(40, 40, 7, 6, seed)),
            ("8 and 7 of 60", lambda seed: fields(60, 60, 8, 7, seed)),
        ),
        "packing": (
            ("8 pieces on 6 x 6", lambda seed: packing(6, 8, seed)),
            ("11 pieces on 7 x 7", lambda seed: packing(7, 11, seed)),
        ),
        "factors": (("5 bits", lambda seed: factors(5, seed)), ("8 bits", lambda seed: factors(8, seed))),
        "timetable": (
            ("30 lectures", lambda seed: timetable(30, 8, 4, 8, seed)),
            ("60 lectures", lambda seed: timetable(60, 10, 7, 12, seed)),
        ),
    },
    "choosing newest": {
        "squads": (
            ("20 of 60 people", lambda seed: squads(20, 60, 10, 0.4, seed)),
            ("28 of 76 people", lambda seed: squads(28, 76, 11, 0.38, seed)),
        ),
        "building": (
            ("4 floors of 5 rooms", lambda seed: building(4, 5, 6, 5, seed)),
            ("10 floors of 8 rooms", lambda seed: building(10, 8, 10, 6, seed)),
        ),
        "bins": (
            ("18 items, 6 bins", lambda seed: bins(18, 6, 3, 1, seed)),
            ("24 items, 8 bins", lambda seed: bins(24, 8, 3, 1, seed)),
        ),
        "hours": (
            ("7 jobs, 8 projects", lambda seed: hours(7, 36, 8, 12, seed)),
            ("9 jobs, 14 projects", lambda seed: hours(9, 40, 14, 16, seed)),
        ),
    },
    "reporting newest": {
        "workshop": (
            ("8 jobs, 6 machines", lambda seed: workshop(8, 6, 30, seed)),
            ("12 jobs, 8 machines", lambda seed: workshop(12, 8, 44, seed)),
        ),
        "tree": (
            ("50 nodes", lambda seed: tree(50, 2, 30, 12, seed)),
            ("70 nodes", lambda seed: tree(70, 2, 40, 14, seed)),
        ),
        "cycles": (
            ("60 nodes", lambda seed: cycles(60, 60, seed)),
            ("120 nodes", lambda seed: cycles(120, 120, seed)),
        ),
        "ladder": (
            ("60 steps of 4", lambda seed: ladder(60, 4, 10, 4, seed)),
            ("60 steps of 6", lambda seed: ladder(60, 6, 14, 5, seed)),
        ),
        "planted": (
            ("50 roles of 8", lambda seed: planted(50, 8, 250, 0.32, seed)),
            ("65 roles of 8", lambda seed: planted(65, 8, 350, 0.3, seed)),
        ),
        "regular": (
            ("50 roles of 24", lambda seed: regular(50, 3, 24, 8, seed)),
            ("60 roles of 30", lambda seed: regular(60, 3, 30, 8, seed)),
        ),
        "magic square": (
            ("5 given", lambda seed: magic(5, seed)),
            ("4 given", lambda seed: magic(4, seed)),
        ),
    },
    "choosing installations": {
        "capacity": (
            ("8 holes for 2, 16 guests", lambda seed: capacity(8, 2, 16, 4, seed)),
            ("8 holes for 2, 17 guests", lambda seed: capacity(8, 2, 17, 5, seed)),
        ),
        "beds": (
            ("8 holes for 2, 16 guests", lambda seed: beds(8, 2, 16, 4, seed)),
            ("8 holes for 2, 17 guests", lambda seed: beds(8, 2, 17, 5, seed)),
        ),
    },
    "reporting installations": {
        "shifts": (
            ("5 days", lambda seed: shifts(5, 12, 0.5, seed)),
            ("14 days", lambda seed: shifts(14, 9, 0.6, seed)),
        ),
        "magazine": (
            ("6 of 30 tools", lambda seed: magazine(30, 6, 12, 12, seed)),
            ("9 of 60 tools", lambda seed: magazine(60, 9, 20, 18, seed)),
        ),
        "redundant": (
            ("twice 6 of 40 relays", lambda seed: redundant(20, 40, 6, 0.25, seed)),
            ("twice 8 of 60 relays", lambda seed: redundant(28, 60, 8, 0.2, seed)),
        ),
        "charging": (
            ("12 robots, 3 chargers", lambda seed: charging(12, 3, 16, seed)),
            ("24 robots, 5 chargers", lambda seed: charging(24, 5, 20, seed)),
        ),
        "zones": (
            ("30 rooms, 3 zones", lambda seed: zones(30, 3, 8, seed)),
            ("60 rooms, 4 zones", lambda seed: zones(60, 4, 10, seed)),
        ),
        "licences": (
            ("12 stations, 4 of 20 servers", lambda seed: licences(12, 40, 14, 20, 4, seed)),
            ("20 stations, 5 of 30 servers", lambda seed: licences(20, 60, 20, 30, 5, seed)),
        ),
        "cabling": (
            ("8 cables, 8 x 8", lambda seed: cabling(8, 8, 8, seed)),
            ("14 cables, 12 x 14", lambda seed: cabling(12, 14, 14, seed)),
        ),
        "voters": (
            ("6 groups", lambda seed: voters(6, 6, 8, seed)),
            ("12 groups", lambda seed: voters(12, 6, 8, seed)),
        ),
    },
    "choosing tasks": {
        "rooms": (
            ("18 rooms", lambda seed: rooms(18, 36, 4, seed)),
            ("36 rooms", lambda seed: rooms(36, 60, 5, seed, 0.3)),
        ),
        "convoy": (
            ("16 robots", lambda seed: convoy(16, 4, 5, seed)),
            ("40 robots", lambda seed: convoy(40, 5, 5, seed)),
        ),
        "orchard": (
            ("7 of 40 drones", lambda seed: orchard(26, 40, 7, 3, seed)),
            ("9 of 60 drones", lambda seed: orchard(36, 60, 9, 4, seed)),
        ),
        "theatres": (
            ("6 theatres", lambda seed: theatres(6, 40, 3, seed)),
            ("12 theatres", lambda seed: theatres(12, 70, 4, seed)),
        ),
    },
    "reporting tasks": {
        "fusion": (
            ("8 platforms", lambda seed: fusion(8, 5, 10, seed)),
            ("20 platforms", lambda seed: fusion(20, 6, 14, seed)),
        ),
        "museum": (
            ("12 groups", lambda seed: museum(12, 16, 7, 9, seed)),
            ("24 groups", lambda seed: museum(24, 30, 9, 14, seed)),
        ),
        "depot": (
            ("4 zones", lambda seed: depot(5, 4, 40, 3, seed)),
            ("8 zones", lambda seed: depot(6, 8, 80, 3, seed)),
        ),
        "patrol": (
            ("14 legs", lambda seed: patrol(14, 7, seed)),
            ("30 legs", lambda seed: patrol(30, 8, seed)),
        ),
    },
    "choosing packings": {
        "tiling": (
            ("8 x 8, 2 of one colour missing", lambda seed: tiling(8, 2, seed, fair=False)),
            ("16 x 16, 3 of both missing", lambda seed: tiling(16, 3, seed)),
        ),
        "triples": (
            ("9 of 8 points", lambda seed: triples(8, 9, seed)),
            ("26 of 13 points", lambda seed: triples(13, 26, seed)),
        ),
        "couples": (
            ("30 people", lambda seed: couples(30, 4, seed)),
            ("100 people", lambda seed: couples(100, 5, seed)),
        ),
    },
    "reporting packings": {
        "trominoes": (
            ("6 x 6", lambda seed: trominoes(6, 0, seed)),
            ("10 x 10, one missing", lambda seed: trominoes(10, 1, seed)),
        ),
        "trios": (
            ("24 people, 60 trios", lambda seed: trios(24, 60, seed)),
            ("48 people, 150 trios", lambda seed: trios(48, 150, seed)),
        ),
    },
    "choosing rosters": {
        "nurses": (
            ("8 nurses, 5 days", lambda seed: nurses(8, 5, 30, seed)),
            ("10 nurses, 4 days", lambda seed: nurses(10, 4, 30, seed)),
        ),
        "machines": (
            ("10 services, 4 machines", lambda seed: machines(10, 4, 5, 5, seed)),
            ("16 services, 6 machines", lambda seed: machines(16, 6, 6, 6, seed)),
        ),
    },
    "reporting rosters": {
        "watched": (
            ("30 places, twice", lambda seed: watched(30, 36, 13, 2, seed)),
            ("40 places, three times", lambda seed: watched(40, 40, 19, 3, seed)),
        ),
        "duties": (
            ("24 trips, 2 bases", lambda seed: duties(24, 4, 2, seed)),
            ("24 trips, 3 bases", lambda seed: duties(24, 4, 3, seed)),
        ),
    },
}
"""The families by what they are for."""

SMALLEST: Mapping[str, Family] = {
    "grid": (("3 x 3", lambda seed: grid(3, 4, 4, seed)),),
    "pigeonholes": (("4 in 3", lambda seed: pigeonholes(4, 3, seed)),),
    "Latin square": (("4, half open", lambda seed: latin(4, 0.5, seed)),),
    "ring": (("5 roles of 2", lambda seed: ring(5, 2, 5, 3, seed)),),
    "relay chain": (("2 hops", lambda seed: relay_chain(2, 8, 0.5, seed)),),
    "missions": (("3 of 8 robots", lambda seed: missions(8, 3, 4, 2, 6, seed)),),
    "relief": (("3 shifts of 2", lambda seed: relief(3, 2, 12, 2, seed)),),
    "coloured parameters": (("4 nodes", lambda seed: coloured_parameters(4, 3, 2.0, seed)),),
    "domination": (("4 on 3 x 3", lambda seed: domination(3, 4, seed)),),
    "sums": (("4 checks", lambda seed: sums(4, 3, seed)),),
    "Latin by parameters": (("3, half open", lambda seed: latin_parameters(3, 0.5, seed)),),
    "crossword": (("2 x 2", lambda seed: crossword(2, 8, 2, seed)),),
    "knights": (("4 on 3 x 3", lambda seed: knights(3, 4, seed)),),
    "teams": (("2 of 2", lambda seed: teams(2, 2, 8, 5, 3, seed)),),
    "circuit": (("10 gates", lambda seed: circuit(4, 10, 2, seed)),),
    "tiling": (("3 x 3, one missing", lambda seed: tiling(3, 1, seed, fair=False)),),
    "triples": (("2 of 5 points", lambda seed: triples(5, 2, seed)),),
    "couples": (("6 people", lambda seed: couples(6, 3, seed)),),
    "trominoes": (("3 x 3", lambda seed: trominoes(3, 0, seed)),),
    "nurses": (("3 nurses, 3 days", lambda seed: nurses(3, 3, 4, seed)),),
    "machines": (("3 services, 2 machines", lambda seed: machines(3, 2, 3, 3, seed)),),
    "watched": (("4 places, twice", lambda seed: watched(4, 8, 5, 2, seed)),),
    "duties": (("6 trips, 2 bases", lambda seed: duties(6, 2, 2, seed)),),
    "trios": (("6 people, 6 trios", lambda seed: trios(6, 6, seed)),),
    "quorum": (("5 roles", lambda seed: quorum(5, 3, 4, 3, seed)),),
    "fields": (("2 and 2 of 6", lambda seed: fields(5, 6, 2, 2, seed)),),
    "packing": (("3 pieces on 4 x 4", lambda seed: packing(4, 3, seed)),),
    "factors": (("2 bits", lambda seed: factors(2, seed)),),
    "timetable": (("4 lectures", lambda seed: timetable(4, 3, 2, 2, seed)),),
    "squads": (("3 of 10 people", lambda seed: squads(3, 10, 4, 0.8, seed)),),
    "building": (("1 floor of 2 rooms", lambda seed: building(1, 2, 3, 2, seed)),),
    "bins": (("5 items, 3 bins", lambda seed: bins(5, 3, 2, 1, seed)),),
    "hours": (("2 jobs, 4 projects", lambda seed: hours(2, 12, 4, 6, seed)),),
    "workshop": (("2 jobs, 2 machines", lambda seed: workshop(2, 2, 9, seed)),),
    "tree": (("6 nodes", lambda seed: tree(6, 2, 4, 3, seed)),),
    "cycles": (("6 nodes", lambda seed: cycles(6, 4, seed)),),
    "ladder": (("3 steps of 2", lambda seed: ladder(3, 2, 3, 3, seed)),),
    "planted": (("5 roles of 3", lambda seed: planted(5, 3, 6, 0.3, seed)),),
    "regular": (("5 roles of 4", lambda seed: regular(5, 2, 4, 3, seed)),),
    "magic square": (("11 given", lambda seed: magic(11, seed)),),
    "capacity": (("2 holes for 2, 3 guests", lambda seed: capacity(2, 2, 3, 2, seed)),),
    "beds": (("2 holes for 2, 3 guests", lambda seed: beds(2, 2, 3, 2, seed)),),
    "shifts": (("1 day", lambda seed: shifts(1, 5, 0.8, seed)),),
    "magazine": (("2 of 5 tools", lambda seed: magazine(5, 2, 3, 4, seed)),),
    "redundant": (("twice 2 of 8 relays", lambda seed: redundant(3, 8, 2, 0.6, seed)),),
    "charging": (("3 robots, 1 charger", lambda seed: charging(3, 1, 8, seed)),),
    "zones": (("4 rooms, 2 zones", lambda seed: zones(4, 2, 3, seed)),),
    "licences": (("2 stations, 2 of 5 servers", lambda seed: licences(2, 8, 4, 5, 2, seed)),),
    "cabling": (("2 cables, 4 x 4", lambda seed: cabling(4, 4, 2, seed)),),
    "voters": (("1 group", lambda seed: voters(1, 3, 4, seed)),),
    "rooms": (("1 room", lambda seed: rooms(1, 4, 2, seed, 0.9)),),
    "convoy": (("4 robots", lambda seed: convoy(4, 2, 3, seed)),),
    "orchard": (("3 of 8 drones", lambda seed: orchard(4, 8, 3, 2, seed, 0.4)),),
    "theatres": (("2 theatres", lambda seed: theatres(2, 9, 2, seed, 2)),),
    "fusion": (("1 platform", lambda seed: fusion(1, 3, 5, seed)),),
    "museum": (("3 groups", lambda seed: museum(3, 5, 4, 5, seed)),),
    "depot": (("1 zone", lambda seed: depot(2, 1, 8, 2, seed)),),
    "patrol": (("4 legs", lambda seed: patrol(4, 3, seed)),),
}
"""One small size of most, to see that everything runs."""
