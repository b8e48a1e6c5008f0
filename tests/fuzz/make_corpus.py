#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes the binary data files of tests/fuzz/corpus. The text files beside them are written by hand.

Needs python3-numpy and python3-h5py.
"""
import gzip
import io
import pathlib
import struct
import subprocess
import zlib

import h5py
import numpy

FOLDER = pathlib.Path(__file__).parent / "corpus" / "data"


def write(name, data):
    (FOLDER / name).write_bytes(data)


def npy(array, version=None):
    out = io.BytesIO()
    numpy.lib.format.write_array(out, array, version=version, allow_pickle=False)
    return out.getvalue()


def write_numpy():
    positions = numpy.arange(12, dtype="<f4").reshape(4, 3)
    rows = numpy.zeros(3, dtype=[("pos", "<f8", (3,)), ("id", ">i4"), ("radius", "<f4"), ("name", "S2")])
    rows["radius"] = 0.5
    rows["name"] = [b"C", b"Fe", b""]
    write("npy/rows.npy", npy(positions))
    write("npy/fortran.npy", npy(numpy.asfortranarray(positions.astype(">f8")), (2, 0)))
    write("npy/structured.npy", npy(rows))
    left_out = numpy.zeros(2, dtype=[("half", "<f2"), ("pos", "<f4", (3,)), ("time", "<M8[ns]"), ("c", "<c16")])
    write("npy/left-out.npy", npy(left_out))
    out = io.BytesIO()
    numpy.savez_compressed(out, pos=positions, type=numpy.array([1, 2, 2, 1], dtype="u1"), box=numpy.eye(3))
    write("npz/deflated.npz", out.getvalue())
    out = io.BytesIO()
    numpy.savez(out, x=positions[:, 0].copy(), y=positions[:, 1].copy(), z=positions[:, 2].copy())
    write("npz/stored.npz", out.getvalue())


def las(minor, point_format, record, count, points):
    size = 375 if minor == 4 else 227
    out = bytearray(size)
    out[0:4] = b"LASF"
    out[24:26] = bytes([1, minor])
    struct.pack_into("<HIIBHI", out, 94, size, size, 0, point_format, record, 0 if minor == 4 else count)
    struct.pack_into("<6d", out, 131, 0.01, 0.01, 0.5, 100, -100, 0)
    if minor == 4:
        struct.pack_into("<Q", out, 247, count)
    return bytes(out) + points


def write_las():
    point = struct.pack("<iiiHBBbBH", 1, -2, 3, 400, 0x11, 2, -5, 7, 9)
    write("las/format0.las", las(2, 0, 20, 2, 2 * point))
    write("las/format3.las", las(2, 3, 34, 2, 2 * (point + struct.pack("<dHHH", 1.5, 65535, 0, 256))))
    extended = struct.pack("<iiiHBBBBhHd", 1, -2, 3, 400, 0x11, 0, 2, 7, -500, 9, 1.5)
    write("las/format7.las", las(4, 7, 36, 2, 2 * (extended + struct.pack("<HHH", 65535, 0, 256))))


def gsd(version, chunks):
    names = []
    data, index = b"", b""
    for frame, name, code, values in chunks:
        values = numpy.atleast_2d(values)
        if name not in names:
            names.append(name)
        index += struct.pack("<QQQIHBB", frame, values.shape[0], 256 + len(data), values.shape[1],
                             names.index(name), code, 0)
        data += values.tobytes()
    packed = b"".join((n.encode() + b"\0").ljust(64 if version == 1 else 0, b"\0") for n in names)
    packed = packed.ljust((len(packed) + 64) // 64 * 64, b"\0")
    at = 256 + len(data)
    header = struct.pack("<QQQQQII", 0x65DF65DF65DF65DF, at + len(packed), len(chunks) + 1, at, len(packed) // 64,
                         0x10004, version << 16)
    header = header.ljust(112, b"\0") + b"hoomd"
    return header.ljust(256, b"\0") + data + packed + index + bytes(32)


def write_gsd():
    types = numpy.array([list(b"A\0"), list(b"Bb")], dtype="i1")
    positions = numpy.array([[1, 2, 3], [-1, -2, -3]], dtype="<f4")
    chunks = [(0, "configuration/step", 4, numpy.array([[100]], dtype="<u8")),
              (0, "configuration/box", 9, numpy.array([[4], [6], [8], [0.5], [0], [0.25]], dtype="<f4")),
              (0, "particles/N", 3, numpy.array([[2]], dtype="<u4")),
              (0, "particles/types", 5, types),
              (0, "particles/typeid", 3, numpy.array([[1], [0]], dtype="<u4")),
              (0, "particles/diameter", 9, numpy.array([[3], [0.5]], dtype="<f4")),
              (0, "particles/position", 9, positions),
              (0, "particles/image", 7, numpy.array([[0, 1, -1], [2, 0, 0]], dtype="<i4")),
              (1, "particles/position", 9, positions * 2),
              (2, "particles/N", 3, numpy.array([[1]], dtype="<u4")),
              (2, "particles/position", 9, positions[:1])]
    write("gsd/version2.gsd", gsd(2, chunks))
    write("gsd/version1.gsd", gsd(1, chunks[:7]))
    bonds = [(0, "bonds/N", 3, numpy.array([[2]], dtype="<u4")),
             (0, "bonds/group", 3, numpy.array([[0, 1], [1, 0]], dtype="<u4"))]
    write("gsd/bonds.gsd", gsd(2, chunks[:8] + bonds))
    broken = [(1, "bonds/N", 3, numpy.array([[0]], dtype="<u4"))]
    write("gsd/broken-bonds.gsd", gsd(2, chunks[:8] + bonds + chunks[8:9] + broken))


def snapshot(name, compression):
    options = dict(chunks=(2, 3), compression="gzip", shuffle=True, fletcher32=True) if compression else {}
    with h5py.File(FOLDER / name, "w", libver="earliest") as out:
        header = out.create_group("Header")
        header.attrs["NumPart_Total"] = numpy.array([0, 3], dtype="u4")
        header.attrs["NumPart_ThisFile"] = numpy.array([0, 3], dtype="u4")
        header.attrs["NumPart_Total_HighWord"] = numpy.array([0, 0], dtype="u4")
        header.attrs["NumFilesPerSnapshot"] = 1
        header.attrs["BoxSize"] = 10.0
        header.attrs["Time"] = 0.5
        particles = out.create_group("PartType1")
        particles.create_dataset("Coordinates", data=numpy.arange(9, dtype="f8").reshape(3, 3), **options)
        if compression:
            return  # as small as possible
        particles.create_dataset("Velocities", data=numpy.ones((3, 3), dtype="f4"))
        particles.create_dataset("ParticleIDs", data=numpy.array([3, 1, 2**63 + 2], dtype="u8"))


def array(kind, name, components, place):
    return (f'<DataArray type="{kind}" Name="{name}" NumberOfComponents="{components}" format="appended" '
            f'offset="{place}"/>').encode()


def vtp(attributes, data, second):
    points, mass = array("Float32", "Points", 3, 0), array("Float64", "mass", 1, second)
    return (b'<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" ' + attributes +
            b'>\n<PolyData><Piece NumberOfPoints="2"><PointData>' + mass + b"</PointData><Points>" + points +
            b'</Points></Piece></PolyData>\n<AppendedData encoding="raw">\n_' + data + b"\n</AppendedData>\n</VTKFile>\n")


def write_vtk():
    positions, mass = struct.pack("<6f", 0, 0, 0, 1, 2, 3), struct.pack("<2d", 1, 2)
    blocks = [struct.pack("<I", len(b)) + b for b in (positions, mass)]
    write("vtk/raw.vtp", vtp(b'header_type="UInt32"', b"".join(blocks), len(blocks[0])))
    blocks = [struct.pack("<4Q", 1, len(b), len(b), len(zlib.compress(b))) + zlib.compress(b)
              for b in (positions, mass)]
    write("vtk/zlib.vtp", vtp(b'header_type="UInt64" compressor="vtkZLibDataCompressor"', b"".join(blocks),
                              len(blocks[0])))


def write_compressed():
    text = (FOLDER / "csv" / "header.csv").read_bytes()
    write("csv/header.csv.gz", gzip.compress(text, mtime=0))
    write("csv/header.csv.zst", subprocess.run(["zstd", "-c"], input=text, capture_output=True, check=True).stdout)


def write_ply():
    header = (b"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty double x\nproperty double y\n"
              b"property double z\nproperty float radius\nproperty uchar red\nproperty uchar green\n"
              b"property uchar blue\nproperty uchar material\nelement face 1\nproperty list uchar int v\n"
              b"end_header\n")
    row = struct.pack("<dddfBBBB", 1, 2, 3, 0.5, 255, 128, 0, 1)
    write("../ply/binary.ply", header + 2 * row + b"\0")
    for name, encoding, order in (("little", "little", "<"), ("big", "big", ">")):
        header = (f"ply\nformat binary_{encoding}_endian 1.0\nelement edge 1\nproperty short v\nelement vertex 2\n"
                  "property float x\nproperty double y\nproperty int z\nproperty float r\nproperty uint material\n"
                  "end_header\n").encode()
        write(f"../ply/{name}.ply", header + b"ee" + 2 * struct.pack(order + "fdifI", 1, 2, 3, 0.5, 0))


if __name__ == "__main__":
    write_numpy()
    write_las()
    write_gsd()
    snapshot("hdf5/plain.hdf5", False)
    snapshot("hdf5/compressed.hdf5", True)
    write_vtk()
    write_ply()
    write_compressed()
