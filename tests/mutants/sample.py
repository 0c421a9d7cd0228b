"""A seeded sample of places, in proportion to how many each folder has of each operator."""
import collections
import hashlib

NUMBERS = 99999  # switch.cpp has room for these


def folder(place):
    return place.file.rsplit("/", 1)[0]


def identity(place):
    """What tells the changes of one text apart."""
    return place.file, place.start, place.end, place.form, place.changed


def without(numbered, others):
    """Those of `numbered` whose places are none of `others`, two lists [(number, place)]."""
    left_out = {identity(place) for _, place in others}
    return [(number, place) for number, place in numbered if identity(place) not in left_out]


def lots(places, seed):
    """[(lot, place)]. A place's lot hangs on the seed and on what is changed, not on where it stands:
    where a line is added elsewhere, the sample stays."""
    seen = collections.Counter()
    drawn = []
    for place in places:
        text = f"{seed} {place.file} {place.original} {place.form} {place.changed}"
        seen[text] += 1
        drawn.append((hashlib.sha256(f"{text} {seen[text]}".encode()).hexdigest(), place))
    return drawn


def stratified(places, count, seed, before=()):
    """[(number, place)]: `count` of `places` without those of `before`, another such list. In the order
    of their lots, so that the first ones are a sample, too. Each stratum (folder, operator) gives its share,
    rounded by the largest remainder. Numbers come from the lots, so that sources whose sample stays need
    not be compiled again."""
    taken_before = {identity(place) for _, place in before}
    places = [p for p in places if identity(p) not in taken_before]
    strata = collections.defaultdict(list)
    for lot, place in lots(places, seed):
        strata[folder(place), place.operator].append((lot, place))
    shares = {key: count * len(members) / len(places) for key, members in strata.items()}
    taken = {key: int(share) for key, share in shares.items()}
    rest = sorted(shares, key=lambda key: (taken[key] - shares[key], key))
    for key in rest[:count - sum(taken.values())]:
        taken[key] += 1
    sample = []
    for key, members in strata.items():
        sample += sorted(members, key=lambda m: m[0])[:taken[key]]
    numbered, used = {}, {number for number, _ in before}
    for lot, place in sorted(sample, key=lambda m: m[0]):
        number = 1 + int(lot[-8:], 16) % NUMBERS
        while number in numbered or number in used:
            number = 1 + number % NUMBERS
        numbered[number] = place
    return list(numbered.items())
