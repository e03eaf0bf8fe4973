# SPDX-License-Identifier: GPL-3.0-or-later
import numpy as np
import pytest
from monocell.core.errors import DocumentError, InvalidValue
from monocell.core.urdf_chain import read_urdf_chain

ARM = """<?xml version="1.0"?>
<robot name="two">
  <link name="base"/><link name="upper"/><link name="slide"/><link name="flange"/>
  <joint name="shoulder" type="revolute">
    <parent link="base"/><child link="upper"/>
    <origin xyz="0 0 0.3"/><axis xyz="0 0 2"/><limit lower="-2" upper="2"/>
  </joint>
  <joint name="rail" type="prismatic">
    <parent link="upper"/><child link="slide"/>
    <origin xyz="0.4 0 0" rpy="0 1.5707963267948966 0"/><axis xyz="0 0 1"/>
    <limit lower="0" upper="0.5"/>
  </joint>
  <joint name="plate" type="fixed">
    <parent link="slide"/><child link="flange"/><origin xyz="0 0 0.1"/>
  </joint>
</robot>"""


@pytest.fixture
def write(tmp_path):
    def written(text):
        path = tmp_path / "arm.urdf"
        path.write_text(text)
        return path

    return written


def test_the_flange_is_where_the_joints_put_it(write):
    chain = read_urdf_chain(write(ARM))
    assert [joint.name for joint in chain.moving] == ["shoulder", "rail"]
    at_rest = chain.base_from_flange([0, 0])
    assert at_rest.translation == pytest.approx([0.5, 0, 0.3])
    # a quarter turn takes x to y, and the rail goes outward
    turned = chain.base_from_flange([np.pi / 2, 0.2])
    assert turned.translation == pytest.approx([0, 0.7, 0.3])
    assert turned.rotation @ [0, 0, 1] == pytest.approx([0, 1, 0])


def test_a_link_in_the_middle_can_be_the_flange(write):
    chain = read_urdf_chain(write(ARM), "upper")
    assert chain.base_from_flange([0.3]).translation == pytest.approx([0, 0, 0.3])


@pytest.mark.parametrize(
    ("values", "told"),
    [
        ([0.1], "1 given, and 2 move between base and flange: shoulder, rail"),
        ([45, 0.1], "shoulder: 45 rad is beyond its limits, -2 to 2 rad; are these degrees?"),
        ([0, 0.6], "rail: 0.6 m is beyond its limits, 0 to 0.5 m"),
        ([0, np.nan], "not finite"),
    ],
)
def test_joints_that_can_not_be_are_named(write, values, told):
    with pytest.raises(InvalidValue, match=told):
        read_urdf_chain(write(ARM)).base_from_flange(values)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("<robot", "<sdf", "no XML"),
        ("</robot>", "", "no XML"),
        ('<link name="flange"/>', '<link name="flange"/><link name="tool"/>', "2 last links"),
        ('type="prismatic"', 'type="floating"', "rail: is floating"),
        ('<axis xyz="0 0 2"/>', '<axis xyz="0 0 0"/>', "axis has no length"),
        ('<axis xyz="0 0 2"/>', '<axis xyz="0 0 x"/>', "xyz should be 3 numbers, not '0 0 x'"),
        ('<axis xyz="0 0 2"/>', '<mimic joint="rail"/>', "follows another joint"),
        ('<parent link="base"/>', "<parent/>", "joint shoulder: has no parent link"),
    ],
)
def test_what_is_no_arm_is_refused(write, old, new, told):
    with pytest.raises(DocumentError, match=told):
        read_urdf_chain(write(ARM.replace(old, new)))


def test_a_xacro_a_missing_file_and_a_missing_link_are_named(write, tmp_path):
    xacro = ARM.replace("<robot ", '<robot xmlns:xacro="http://x" ').replace(
        '<link name="base"/>', '<link name="base"/><xacro:arm/>'
    )
    with pytest.raises(DocumentError, match="is a xacro file"):
        read_urdf_chain(write(xacro.replace('xmlns:xacro="http://x"', 'xmlns:xacro="xacro"')))
    with pytest.raises(DocumentError, match="there is no such file"):
        read_urdf_chain(tmp_path / "none.urdf")


def test_links_in_a_circle_are_refused(write):
    circle = write(ARM.replace('<parent link="base"/>', '<parent link="slide"/>'))
    with pytest.raises(DocumentError, match="round in a circle"):
        read_urdf_chain(circle, "flange")


def test_a_missing_link_is_named_with_those_that_are_there(write):
    with pytest.raises(DocumentError, match="no link is called 'tool'; there are base, upper"):
        read_urdf_chain(write(ARM), "tool")
