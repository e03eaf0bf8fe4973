# SPDX-License-Identifier: GPL-3.0-or-later
"""The named refusals: each carries the numbers that led to it and what to do next."""


class MonocellError(Exception):
    """Base of everything monocell refuses; its message is one line fit to show a user."""


class InvalidValue(MonocellError):
    """A number is outside what the geometry allows (NaN, negative radius, skewed rotation)."""


class DocumentError(MonocellError):
    """A document or camera file can't be read; the message begins with the path of the field."""


class PictureError(MonocellError):
    """A picture is missing, truncated, or not of the camera's size."""


class NoPose(MonocellError):
    """A camera pose is needed and the camera has none yet."""


class SphereNotFound(MonocellError):
    """No ball outline, or none that can be believed, was found where it was looked for."""


class SphereCut(SphereNotFound):
    """The ball leaves the picture, so that too little of its outline is left."""


class TooFewSightings(MonocellError):
    """Fewer sightings than a pose needs."""


class DegeneratePositions(MonocellError):
    """The ball's positions lie on a line or in one place, which leaves the pose undetermined."""


class BoardNotFound(MonocellError):
    """No calibration board, or none fit to be measured, was found in a picture."""


class TooFewPictures(MonocellError):
    """Fewer pictures of a calibration board than a lens needs."""


class AmbiguousPose(MonocellError):
    """Several poses fit the sightings equally well."""


class NotObservable(MonocellError):
    """Something is to be refined that these sightings can't tell well enough."""


class PickError(MonocellError):
    """A picked pixel can't mean what it was picked for (above the horizon, behind the camera)."""


class NotConverged(MonocellError):
    """A least-squares problem found no minimum: the numbers given contradict each other."""


class RenderFailed(MonocellError):
    """Blender ended a render or an export without the file that was asked for."""


class MissingPackage(MonocellError):
    """An optional package that the job needs is not installed."""


class Unreachable(MonocellError):
    """No joint angles within the limits bring the arm where it is asked to be."""


class InCollision(MonocellError):
    """The arm touches something, or comes too near, where it has to start or to end."""


class NoPath(MonocellError):
    """No path was found that keeps its distance from everything."""


class DegenerateReference(MonocellError):
    """What a reference was made from leaves its place open, or leads back to the reference."""
