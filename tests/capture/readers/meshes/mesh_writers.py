"""Writers of solids that are not ours: trimesh, laspy, pye57, usd-core, and bytes by hand.

PLY files are built byte by byte from the format's public description (G. Turk, "The PLY Polygon
File Format", 1994).
"""

import io
import struct
import zipfile

import numpy as np
import trimesh
from PIL import Image

Y_UP = np.array([[1.0, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]])


def as_trimesh(quads):
    vertices, faces, colour, _ = quads.triangles()
    rgba = np.column_stack([colour, np.full(len(colour), 255)])
    return trimesh.Trimesh(vertices, faces, vertex_colors=rgba, process=False)


def write_glb(path, quads):
    mesh = as_trimesh(quads)
    half = trimesh.Scene()
    half.add_geometry(mesh, transform=Y_UP)  # The turn lies in the node: it must be applied.
    path.write_bytes(half.export(file_type="glb"))


def write_stl(path, quads):
    path.write_bytes(as_trimesh(quads).export(file_type="stl"))


def write_obj(folder, quads, name="room"):
    """An OBJ, y up, whose colours lie in a picture: one pixel a quad, read by uv."""
    folder.mkdir(exist_ok=True)
    side = int(np.ceil(np.sqrt(len(quads.colour))))
    picture = np.zeros((side * side, 3), np.uint8)
    picture[: len(quads.colour)] = quads.colour
    Image.fromarray(picture.reshape(side, side, 3)).save(folder / "paint.png")
    (folder / f"{name}.mtl").write_text("newmtl paint\nKd 1 1 1\nmap_Kd paint.png\n")
    lines = [f"mtllib {name}.mtl", "usemtl paint"]
    for x, y, z in quads.corners.reshape(-1, 3):
        lines.append(f"v {x} {z} {-y}")
    for number in range(len(quads.colour)):
        row, column = divmod(number, side)
        lines.append(f"vt {(column + 0.5) / side} {1 - (row + 0.5) / side}")
    for number in range(len(quads.colour)):
        corners = " ".join(f"{4 * number + k}/{number + 1}" for k in (1, 2, 3, 4))
        lines.append(f"f {corners}")
    (folder / f"{name}.obj").write_text("\n".join(lines) + "\n")
    return folder / f"{name}.obj"


def zipped(path, folder):
    with zipfile.ZipFile(path, "w") as archive:
        for file in sorted(folder.iterdir()):
            archive.write(file, f"export/{file.name}")


def write_usdz(path, quads):
    from pxr import Gf, Usd, UsdGeom, UsdUtils, Vt

    plain = path.with_suffix(".usdc")
    stage = Usd.Stage.CreateNew(str(plain))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    mesh = UsdGeom.Mesh.Define(stage, "/Room/Mesh")
    points = quads.corners.reshape(-1, 3) @ Y_UP[:3, :3].T * 100
    mesh.CreatePointsAttr(Vt.Vec3fArray([Gf.Vec3f(*map(float, p)) for p in points]))
    mesh.CreateFaceVertexCountsAttr([4] * len(quads.corners))
    mesh.CreateFaceVertexIndicesAttr(list(range(4 * len(quads.corners))))
    colours = UsdGeom.PrimvarsAPI(mesh).CreatePrimvar(
        "displayColor", colour_kind(), UsdGeom.Tokens.uniform
    )
    linear = (quads.colour / 255.0) ** 2.2
    colours.Set(Vt.Vec3fArray([Gf.Vec3f(*map(float, c)) for c in linear]))
    stage.GetRootLayer().Save()
    assert UsdUtils.CreateNewUsdzPackage(str(plain), str(path))
    plain.unlink()


def colour_kind():
    from pxr import Sdf

    return Sdf.ValueTypeNames.Color3fArray


def write_las(path, points, colour):
    import laspy

    header = laspy.LasHeader(point_format=3, version="1.2")
    header.offsets, header.scales = [500_000.0, 4_000_000.0, 0.0], [0.001] * 3
    las = laspy.LasData(header)
    las.x, las.y, las.z = points[:, 0] + 500_000, points[:, 1] + 4_000_000, points[:, 2]
    las.red, las.green, las.blue = colour.T.astype(np.uint16) * 257
    las.write(str(path))


def write_e57(path, points, colour):
    """Two scans, each in a frame of its own, that only their poses put together."""
    import pye57

    turn = trimesh.transformations.quaternion_from_matrix(
        trimesh.transformations.rotation_matrix(0.6, [0, 0, 1])
    )
    with pye57.E57(str(path), mode="w") as file:
        for part, shift in ((slice(0, None, 2), [1.0, 2.0, 0.5]), (slice(1, None, 2), [0, 0, 0])):
            world_to_scan = np.linalg.inv(trimesh.transformations.quaternion_matrix(turn))
            own = (points[part] - shift) @ world_to_scan[:3, :3].T
            data = {f"cartesian{axis}": own[:, a] for a, axis in enumerate("XYZ")}
            for a, name in enumerate(("Red", "Green", "Blue")):
                data[f"color{name}"] = colour[part, a]
            file.write_scan_raw(data, rotation=turn, translation=np.array(shift, float))


def write_text(path, points, colour, separator=" ", head=""):
    buffer = io.StringIO()
    rows = np.column_stack([points, colour])
    np.savetxt(buffer, rows, fmt=["%.4f"] * 3 + ["%d"] * 3, delimiter=separator)
    path.write_text(head + buffer.getvalue())


def ply_bytes(order, vertex, faces=None, face_columns=(), comments=()):
    """A PLY: ``vertex`` is a list of (name, kind, values), ``faces`` a list of corner lists."""
    names = {"f4": "float", "f8": "double", "u1": "uchar", "i4": "int", "u2": "ushort"}
    count = len(vertex[0][2])
    formats = {"a": "ascii", "<": "binary_little_endian", ">": "binary_big_endian"}
    lines = ["ply", f"format {formats[order]} 1.0", *(f"comment {c}" for c in comments)]
    lines += [f"element vertex {count}"]
    lines += [f"property {names[kind]} {name}" for name, kind, _ in vertex]
    if faces is not None:
        lines += [f"element face {len(faces)}", "property list uchar int vertex_indices"]
        lines += [f"property {names[kind]} {name}" for name, kind, _ in face_columns]
    data = ("\n".join([*lines, "end_header"]) + "\n").encode()
    if order == "a":
        for row in range(count):
            data += (" ".join(f"{values[row]:g}" for _, _, values in vertex) + "\n").encode()
        for row, corners in enumerate(faces or ()):
            own = [len(corners), *corners, *(values[row] for _, _, values in face_columns)]
            data += (" ".join(map(str, own)) + "\n").encode()
        return data
    rows = np.zeros(count, [(name, order + kind) for name, kind, _ in vertex])
    for name, _, values in vertex:
        rows[name] = values
    pieces = [data, rows.tobytes()]
    for row, corners in enumerate(faces or ()):
        pieces.append(bytes([len(corners)]) + struct.pack(f"{order}{len(corners)}i", *corners))
        for _, kind, values in face_columns:
            pieces.append(np.array(values[row], order + kind).tobytes())
    return b"".join(pieces)


def places(points):
    return [(axis, "f4", points[:, a]) for a, axis in enumerate("xyz")]


def paints(colour):
    return [(name, "u1", colour[:, c]) for c, name in enumerate(("red", "green", "blue"))]


def quad_ply(quads, order="<", more=(), face_columns=()):
    """The quads as they are, four corners a face."""
    corners = quads.corners.reshape(-1, 3)
    colour = np.repeat(quads.colour, 4, axis=0)
    faces = [[4 * q, 4 * q + 1, 4 * q + 2, 4 * q + 3] for q in range(len(quads.corners))]
    return ply_bytes(order, [*places(corners), *paints(colour), *more], faces, face_columns)
