# SPDX-License-Identifier: GPL-3.0-or-later
"""What a random user does in Blender round the add-on: objects, modes, scenes, collections."""

from __future__ import annotations

NAMES = ("box", "x", "a b", "Cell camera", "floor", "crate.top", "box.001", "ünï", "y" * 63, "a.b")


class BlenderMoves:
    """Blender's own operators on what is there, ours or not."""

    def does_select(self):
        layer = self.bpy.context.view_layer
        for ob in layer.objects:
            ob.select_set(self.chance(0.3))
        layer.objects.active = self.one_of(layer.objects)
        self.by_hand("selected")

    does_select.often = 10

    def does_rename(self):
        ob = self.one_of(self.scene.objects)
        if ob is not None:
            ob.name = self.one_of(NAMES)
            self.by_hand(f"renamed to {ob.name}")

    does_rename.often = 8

    def does_rename_other(self):
        data = self.bpy.data
        named = [*data.meshes, *data.scenes, *data.collections, *data.materials, *data.images]
        self.one_of(named).name = self.one_of(NAMES)
        self.by_hand("data renamed")

    does_rename_other.often = 2

    def does_delete(self):
        self.blender(self.bpy.ops.object.delete, use_global=self.chance(0.3))

    does_delete.often = 6

    def does_delete_camera(self):
        camera = self.stored.camera
        if camera is not None and self.bpy.context.mode == "OBJECT":
            self.bpy.data.objects.remove(camera)
            self.by_hand("camera deleted")

    does_delete_camera.often = 1

    def does_duplicate(self):
        self.blender(self.bpy.ops.object.duplicate, linked=self.chance(0.4))

    does_duplicate.often = 6

    def does_parent(self):
        kind = self.one_of(["OBJECT", "VERTEX"])
        self.blender(self.bpy.ops.object.parent_set, type=kind, keep_transform=self.chance(0.5))

    def does_unparent(self):
        kind = self.one_of(["CLEAR", "CLEAR_KEEP_TRANSFORM"])
        self.blender(self.bpy.ops.object.parent_clear, type=kind)

    does_unparent.often = 2

    def does_hide(self):
        ob = self.one_of(self.bpy.context.view_layer.objects)
        if ob is not None:
            if self.chance(0.5):
                ob.hide_set(not ob.hide_get())
            else:
                ob.hide_viewport = not ob.hide_viewport
            self.by_hand(f"hid {ob.name}")

    def does_transform(self):
        ob = self.one_of(self.things())
        if ob is None:
            return
        kind = self.one_of(["location", "rotation_euler", "scale", "delta_location"])
        axis = int(self.rng.integers(3))
        if kind == "scale" and self.chance(0.6):
            ob.scale = [float(self.rng.uniform(0.3, 2))] * 3
        elif kind == "scale":
            ob.scale[axis] *= float(self.one_of([-1, 0.5, 2, 0.0]))
        else:
            getattr(ob, kind)[axis] += float(self.rng.normal(0, 0.2))
        self.bpy.context.view_layer.update()
        self.by_hand(f"{kind} of {ob.name}")

    does_transform.often = 10

    def does_move_camera(self):
        camera = self.scene.camera
        if camera is not None:
            camera.location.x += 0.01
            if camera.type == "CAMERA":
                camera.data.lens *= 1.1
            self.by_hand("camera moved")

    does_move_camera.often = 2

    def does_apply(self):
        self.blender(
            self.bpy.ops.object.transform_apply,
            location=self.chance(0.5),
            rotation=self.chance(0.5),
            scale=True,
        )

    def does_origin(self):
        self.blender(self.bpy.ops.object.origin_set, type="ORIGIN_CURSOR")

    does_origin.often = 2

    def does_edit_mode(self):
        if self.bpy.context.mode == "OBJECT":
            ob = self.one_of(self.things())
            if ob is not None and ob.name in self.bpy.context.view_layer.objects:
                self.bpy.context.view_layer.objects.active = ob
        mode = self.one_of(["EDIT", "EDIT", "SCULPT", "OBJECT"])
        self.blender(self.bpy.ops.object.mode_set, mode=mode)

    does_edit_mode.often = 6

    def does_edit_mesh(self):
        """In edit mode the mesh is moved, cut or emptied."""
        if self.bpy.context.mode != "EDIT_MESH":
            return
        mesh = self.bpy.ops.mesh
        self.blender(mesh.select_all, action=self.one_of(["SELECT", "DESELECT", "INVERT"]))
        what = self.one_of([mesh.subdivide, mesh.delete, mesh.flip_normals, mesh.dissolve_faces])
        self.blender(what)

    does_edit_mesh.often = 4

    def does_leave_mode(self):
        self.blender(self.bpy.ops.object.mode_set, mode="OBJECT")

    does_leave_mode.often = 8

    def does_add_foreign(self):
        add = self.one_of([self.bpy.ops.mesh.primitive_cube_add, self.bpy.ops.object.camera_add])
        self.blender(add)

    does_add_foreign.often = 2

    def does_join(self):
        self.blender(self.bpy.ops.object.join)

    does_join.often = 1

    def does_convert(self):
        self.blender(self.bpy.ops.object.convert, target=self.one_of(["CURVE", "MESH"]))

    does_convert.often = 1

    def does_single_user(self):
        self.blender(self.bpy.ops.object.make_single_user, object=True, obdata=True)

    does_single_user.often = 2

    def does_modifier(self):
        self.blender(self.bpy.ops.object.modifier_add, type=self.one_of(["BEVEL", "ARRAY"]))

    does_modifier.often = 1

    def does_material(self):
        ob = self.one_of(self.things())
        if ob is not None:
            kind = self.one_of(["clear", "none", "other"])
            ob.data.materials.clear()
            if kind != "clear":
                other = self.bpy.data.materials.new("other") if kind == "other" else None
                ob.data.materials.append(other)
            self.by_hand(f"material {kind}")

    does_material.often = 2

    def does_collection(self):
        """The cell's collection renamed, unlinked, excluded, removed, or an object taken out."""
        held, ob = self.stored.collection, self.one_of(self.things())
        kind = self.one_of(["take out", "put in", "exclude", "remove", "unlink"])
        layers = self.bpy.context.view_layer.layer_collection.children
        if kind == "take out" and ob is not None and held is not None and ob.name in held.objects:
            held.objects.unlink(ob)
            self.scene.collection.objects.link(ob)
        elif kind == "put in" and held is not None:
            for other in list(self.scene.collection.objects):
                if other.name not in held.objects:
                    held.objects.link(other)
        elif kind == "exclude" and held is not None and held.name in layers:
            layers[held.name].exclude = not layers[held.name].exclude
        elif kind == "remove" and held is not None and self.bpy.context.mode == "OBJECT":
            self.bpy.data.collections.remove(held)
        elif kind == "unlink" and held is not None and held.name in self.scene.collection.children:
            self.scene.collection.children.unlink(held)
        self.by_hand(f"collection: {kind}")

    does_collection.often = 3

    def does_new_scene(self):
        kind = self.one_of(["NEW", "EMPTY", "LINK_COPY", "FULL_COPY"])
        if len(self.bpy.data.scenes) < 6 and self.bpy.context.mode == "OBJECT":
            self.blender(self.bpy.ops.scene.new, type=kind)

    does_new_scene.often = 2

    def does_go_to_scene(self):
        if self.bpy.context.mode == "OBJECT":
            self.bpy.context.window.scene = self.one_of(self.bpy.data.scenes)
            self.by_hand("another scene")

    does_go_to_scene.often = 3

    def does_delete_scene(self):
        if self.bpy.context.mode == "OBJECT":
            self.blender(self.bpy.ops.scene.delete)

    does_delete_scene.often = 2

    def does_cursor(self):
        self.scene.cursor.location = self.rng.normal(0, 0.3, 3)
        self.by_hand("cursor")

    does_cursor.often = 1

    def does_render_size(self):
        render = self.scene.render
        render.resolution_x = self.one_of([4, 800, 1920])
        render.pixel_aspect_x = self.one_of([1.0, 2.0])
        self.by_hand("render size")

    does_render_size.often = 1

    def does_purge(self):
        purge = self.bpy.ops.outliner.orphans_purge
        self.blender(purge, do_local_ids=True, do_linked_ids=True, do_recursive=True)

    does_purge.often = 2
