"""What a campaign changes, whom it asks, and where it writes."""
import dataclasses


@dataclasses.dataclass(frozen=True)
class Area:
    folders: tuple[str, ...]  # whose sources are changed
    subjects: tuple[str, ...]  # of the test programs
    work: str  # in build: what was measured
    page: str  # in docs; its template stands here, with ".in"


# The programs link the four libraries, or call the command, which does. Left out, for what they take to build and
# to run: blind and experiments; and house, which links nothing.
LIBRARIES = Area(
    folders=("models", "reference", "fast", "proofs/certificate"),
    subjects=("inertia", "orders", "robot", "shapes", "motion", "physics", "masses", "division", "identify",
              "recovery", "simulation", "fast", "certificate", "diagnosis", "hostile", "app", "track"),
    work="mutants", page="mutants.md")

DIAGNOSIS = Area(
    folders=("diagnosis", "diagnosis/effects"), subjects=("diagnosis", "app", "hostile"),
    work="mutants_diagnosis", page="mutants_diagnosis.md")
