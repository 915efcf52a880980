"""Opens this folder in Blender 3.4 or later: cameras with their photographs behind them, and the
points, upright. Run it in Blender's text editor, or: blender --python open_in_blender.py"""
import json
import os

import bpy
import numpy
from mathutils import Matrix, Vector

TYPES = {"float": "<f4", "uchar": "u1"}
SENSOR_MM = 36
# Blender's text editor gives the file's path as a folder of the .blend file.
PLACE = os.path.dirname(bpy.path.abspath(bpy.context.space_data.text.filepath)
                        if getattr(bpy.context.space_data, "text", None)
                        else os.path.abspath(__file__))


def read_points(path):
    with open(path, "rb") as stream:
        fields = []
        for line in iter(lambda: stream.readline().split(), [b"end_header"]):
            if line[:2] == [b"element", b"vertex"]:
                count = int(line[2])
            if line[0] == b"property":
                fields.append((line[2].decode(), TYPES[line[1].decode()]))
        return numpy.fromfile(stream, fields, count)


def add_points(points, root):
    mesh = bpy.data.meshes.new("points")
    mesh.vertices.add(len(points))
    places = numpy.stack([points[axis] for axis in "xyz"], 1)
    mesh.vertices.foreach_set("co", places.astype("f4").ravel())
    srgb = numpy.stack([points[c] / 255 for c in ("red", "green", "blue")], 1)
    linear = numpy.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)
    colors = numpy.concatenate([linear, numpy.ones((len(points), 1))], 1).astype("f4")
    mesh.attributes.new("photo_color", "FLOAT_COLOR", "POINT").data.foreach_set("color", colors.ravel())
    mesh.attributes.new("radius", "FLOAT", "POINT").data.foreach_set(
        "value", numpy.ascontiguousarray(points["radius"]))
    place = bpy.data.objects.new("points", mesh)
    bpy.context.scene.collection.objects.link(place)
    place.parent = root
    place.modifiers.new("points", "NODES").node_group = make_nodes(make_material())


def make_material():
    """Colours as the photographs have them, without light of the scene's."""
    material = bpy.data.materials.new("points")
    material.use_nodes = True
    nodes, links = material.node_tree.nodes, material.node_tree.links
    nodes.clear()
    color, light = nodes.new("ShaderNodeAttribute"), nodes.new("ShaderNodeEmission")
    out = nodes.new("ShaderNodeOutputMaterial")
    color.attribute_name = "photo_color"  # Cycles has a "color" of its own
    links.new(color.outputs["Color"], light.inputs["Color"])
    links.new(light.outputs["Emission"], out.inputs["Surface"])
    return material


def make_nodes(material):
    """Vertices become points with their own radii, which Cycles renders."""
    group = bpy.data.node_groups.new("points", "GeometryNodeTree")
    if hasattr(group, "interface"):  # from Blender 4.0 on
        for direction in ("INPUT", "OUTPUT"):
            group.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    else:
        group.inputs.new("NodeSocketGeometry", "Geometry")
        group.outputs.new("NodeSocketGeometry", "Geometry")
    first, last = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    points, paint = (group.nodes.new("GeometryNodeMeshToPoints"),
                     group.nodes.new("GeometryNodeSetMaterial"))
    radius = group.nodes.new("GeometryNodeInputNamedAttribute")
    radius.data_type = "FLOAT"
    radius.inputs["Name"].default_value = "radius"
    paint.inputs["Material"].default_value = material
    value = next(s for s in radius.outputs if s.enabled and s.type == "VALUE")
    group.links.new(first.outputs[0], points.inputs["Mesh"])
    group.links.new(value, points.inputs["Radius"])
    group.links.new(points.outputs[0], paint.inputs["Geometry"])
    group.links.new(paint.outputs[0], last.inputs[0])
    return group


def add_camera(frame, root):
    path = os.path.join(PLACE, frame["file_path"])
    data = bpy.data.cameras.new(os.path.basename(path))
    width, height = frame["w"], frame["h"]
    data.sensor_fit, data.sensor_width = "HORIZONTAL", SENSOR_MM
    data.lens = frame["fl_x"] * SENSOR_MM / width
    data.shift_x = (width / 2 - frame["cx"]) / width
    data.shift_y = (frame["cy"] - height / 2) / width * frame["fl_x"] / frame["fl_y"]  # in widths, too
    data.show_background_images = True
    behind = data.background_images.new()
    behind.image = bpy.data.images.load(path)
    behind.alpha = 1
    camera = bpy.data.objects.new(data.name, data)
    bpy.context.scene.collection.objects.link(camera)
    camera.parent = root
    camera.matrix_local = Matrix(frame["transform_matrix"])
    return camera


def main():
    with open(os.path.join(PLACE, "transforms.json"), encoding="utf-8") as stream:
        root = json.load(stream)
    frames = root["frames"]
    # People hold cameras level: what is up in the pictures, as EXIF turns them, becomes Blender's z.
    up = Vector(root["up"])
    place = bpy.data.objects.new("scene", None)
    bpy.context.scene.collection.objects.link(place)
    place.matrix_world = up.rotation_difference(Vector((0, 0, 1))).to_matrix().to_4x4()
    cameras = [add_camera(f, place) for f in frames]
    if "ply_file_path" in root:  # a scene may have no points
        add_points(read_points(os.path.join(PLACE, root["ply_file_path"])), place)
    render = bpy.context.scene.render
    render.resolution_x, render.resolution_y = frames[0]["w"], frames[0]["h"]
    # A camera has one focal length: where the photographs have two, pixels are not square. Neither side is below 1.
    ratio = frames[0]["fl_x"] / frames[0]["fl_y"]
    render.pixel_aspect_x, render.pixel_aspect_y = max(1, 1 / ratio), max(1, ratio)
    bpy.context.scene.camera = cameras[0]
    bpy.context.scene.view_settings.view_transform = "Standard"  # colours as in the photographs


main()
