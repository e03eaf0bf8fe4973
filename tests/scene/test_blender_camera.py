# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from monocell.core.distortion import Distortion
from monocell.core.errors import InvalidValue
from monocell.core.intrinsics import Intrinsics
from monocell.core.pose import Pose

pytestmark = pytest.mark.blender

CASES = {
    "landscape": Intrinsics(160, 120, 200.0, 200.0, 79.5, 59.5),
    "off-centre principal point": Intrinsics(160, 120, 190.0, 190.0, 61.3, 83.8),
    "portrait": Intrinsics(120, 160, 200.0, 200.0, 64.2, 71.1),
    "pixels taller than wide": Intrinsics(160, 120, 230.0, 180.0, 74.0, 66.6),
    "pixels wider than tall": Intrinsics(160, 120, 170.0, 210.0, 88.4, 51.9),
    "portrait, off-centre, tall pixels": Intrinsics(120, 160, 210.0, 160.0, 43.5, 97.7),
}
POSE = Pose.looking_at([2.0, -1.5, 1.2], [0.1, 0.2, 0.1], [0.1, 0.0, 1.0])


@pytest.fixture
def stage(blender):
    camera = blender.data.objects.new("camera", blender.data.cameras.new("camera"))
    blender.context.scene.collection.objects.link(camera)
    blender.context.scene.camera = camera
    return blender, blender.context.scene, camera


def discs(bpy, scene, camera_from_world, centres_camera, radius):
    """Luminous discs that face the picture plane: their images are ellipses about the centre."""
    from monocell.scene.transforms import matrix_of

    material = bpy.data.materials.new("light")
    if bpy.app.version < (5, 0):
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    light, out = (tree.nodes.new(f"ShaderNode{n}") for n in ("Emission", "OutputMaterial"))
    tree.links.new(light.outputs[0], out.inputs[0])
    turn = np.linspace(0, 2 * np.pi, 256, endpoint=False)
    rim = np.stack([np.cos(turn), np.sin(turn), 0 * turn], 1) * radius
    for i, centre in enumerate(centres_camera):
        mesh = bpy.data.meshes.new(f"disc {i}")
        mesh.from_pydata(rim.tolist(), [], [list(range(len(rim)))])
        mesh.materials.append(material)
        ob = bpy.data.objects.new(f"disc {i}", mesh)
        ob.matrix_world = matrix_of(camera_from_world.inverse() @ Pose(np.eye(3), centre))
        scene.collection.objects.link(ob)


def centroid(picture, near, reach):
    """The centre of light (u, v) in a square of the picture."""
    low = np.maximum(np.round(near).astype(int) - reach, 0)
    part = picture[low[1] : low[1] + 2 * reach + 1, low[0] : low[0] + 2 * reach + 1, 0]
    v, u = np.mgrid[: part.shape[0], : part.shape[1]]
    return np.array([(part * u).sum(), (part * v).sum()]) / part.sum() + low


@pytest.mark.parametrize("intrinsics", CASES.values(), ids=CASES.keys())
def test_rendered_targets_lie_where_the_intrinsics_project_them(stage, intrinsics):
    from monocell.core.camera import Camera
    from monocell.scene.rendering import render_linear

    bpy, scene, _ = stage
    pixels = np.array(
        [[22.0, 25.0], [intrinsics.width - 30.3, 31.6], [55.5, intrinsics.height - 24.2]]
    )
    centres = intrinsics.rays(pixels)
    centres *= 2.0 / centres[:, 2:]
    discs(bpy, scene, POSE, centres, radius=0.11)
    picture = render_linear(scene, Camera(intrinsics, POSE), samples=256, bounces=0)
    found = [centroid(picture, pixel, 20) for pixel in pixels]
    assert np.abs(found - intrinsics.project(centres)).max() < 0.02


@pytest.mark.parametrize("intrinsics", CASES.values(), ids=CASES.keys())
def test_a_camera_read_back_projects_the_same(stage, intrinsics):
    from monocell.scene.blender_camera import place_camera, read_camera

    _, scene, camera = stage
    place_camera(camera, scene.render, intrinsics, POSE)
    back = read_camera(camera, scene.render)
    points = np.array([[0.1, 0.2, 0.0], [-0.3, 0.4, 0.2], [0.5, -0.2, 0.7]])
    truth = intrinsics.project(POSE.apply(points))
    assert np.abs(back.project(points) - truth).max() < 1e-3
    assert (back.intrinsics.width, back.intrinsics.height) == (intrinsics.width, intrinsics.height)


def test_distortion_survives_in_the_camera(stage):
    from monocell.scene.blender_camera import place_camera, read_camera

    _, scene, camera = stage
    lens = Distortion("plumb_bob", np.array([-0.28, 0.09, 0.0006, -0.0004, -0.01]))
    place_camera(camera, scene.render, Intrinsics(640, 480, 500, 500, 320, 240, lens), POSE)
    back = read_camera(camera, scene.render).intrinsics.distortion
    assert back.model == "plumb_bob"
    assert back.coefficients.tolist() == lens.coefficients.tolist()


@pytest.mark.parametrize("fit", ["AUTO", "HORIZONTAL", "VERTICAL"])
@pytest.mark.parametrize("size", [(160, 120), (120, 160)])
def test_a_camera_that_a_user_made_projects_as_blender_does(stage, fit, size):
    from bpy_extras.object_utils import world_to_camera_view
    from mathutils import Vector
    from monocell.scene.blender_camera import read_camera

    bpy, scene, camera = stage
    camera.data.sensor_fit, camera.data.lens = fit, 41.0
    camera.data.shift_x, camera.data.shift_y = 0.07, -0.03
    camera.location, camera.rotation_euler = (0.3, -3.0, 1.0), (1.2, 0.1, 0.2)
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.pixel_aspect_x, scene.render.pixel_aspect_y = 1.0, 1.3
    back = read_camera(camera, scene.render)
    bpy.context.view_layer.update()
    points = np.array([[0.1, 0.2, 0.0], [-0.3, 0.4, 0.2], [0.5, -0.2, 0.7]])
    seen = np.array([world_to_camera_view(scene, camera, Vector(p)) for p in points])
    corner = np.stack([seen[:, 0] * size[0], (1 - seen[:, 1]) * size[1]], 1)
    assert np.abs(back.project(points) - (corner - 0.5)).max() < 1e-3


def test_a_lens_shorter_than_blenders_is_refused(stage):
    from monocell.scene.blender_camera import place_camera

    _, scene, camera = stage
    with pytest.raises(InvalidValue, match=r"17\.8 px"):
        place_camera(camera, scene.render, Intrinsics(640, 480, 12, 12, 320, 240), POSE)


def test_an_orthographic_camera_is_refused(stage):
    from monocell.scene.blender_camera import read_camera

    _, scene, camera = stage
    camera.data.type = "ORTHO"
    with pytest.raises(InvalidValue, match="ORTHO"):
        read_camera(camera, scene.render)
