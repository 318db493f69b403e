#!/usr/bin/env python3
# SPDX-FileCopyrightText: picolo contributors
# SPDX-License-Identifier: Apache-2.0
"""Writes the seeds of the fuzz targets into tests/fuzz/corpus: packets and texts made up here, none recorded."""
import pathlib
import struct

ROOT = pathlib.Path(__file__).parent / "corpus"


def save(target, name, data):
    folder = ROOT / target
    folder.mkdir(parents=True, exist_ok=True)
    (folder / name).write_bytes(data if isinstance(data, bytes) else data.encode())


def crc8(data):
    crc = 0
    for byte in data:
        crc ^= byte
        for _ in range(8):
            crc = ((crc << 1) ^ 0x4D) & 0xFF if crc & 0x80 else (crc << 1) & 0xFF
    return crc


def crc16(data):
    crc = 0
    for byte in data:
        crc ^= byte << 8
        for _ in range(8):
            crc = ((crc << 1) ^ 0x1021) & 0xFFFF if crc & 0x8000 else (crc << 1) & 0xFFFF
    return crc


def ld06(number):
    data = struct.pack("<BBHH", 0x54, 0x2C, 3600, number * 960 % 36000)
    for i in range(12):
        data += struct.pack("<HB", 1000 + 12 * number + i, 200)
    data += struct.pack("<HH", (number * 960 + 880) % 36000, number * 3)
    return data + bytes([crc8(data)])


def node(number):
    angle = number * 115
    return struct.pack("<BHH", 0x3D if number == 0 else 0x3E, (angle << 1) | 1, 4000 + 8 * number)


def capsule(number, size):
    body = struct.pack("<H", number * 36 * 64 % (360 * 64)) + bytes((7 * number + 3 * i) & 0xFF for i in range(size - 4))
    total = 0
    for byte in body:
        total ^= byte
    return bytes([0xA0 | (total & 15), 0x50 | (total >> 4)]) + body


def ydlidar(number, width):
    samples = [(1000 + i) << 2 for i in range(20)]
    words = [0x55AA, 20 << 8, (number * 1280 % 23040 << 1) | 1, ((number * 1280 + 1216) % 23040 << 1) | 1]
    total = words[0] ^ words[1] ^ words[2] ^ words[3]
    body = b""
    for sample in samples:
        if width == 3:
            body += b"\x40"
            total ^= 0x40
        body += struct.pack("<H", sample)
        total ^= sample
    return struct.pack("<5H", *words, total) + body


def scip():
    def line(text):
        return text + chr((sum(map(ord, text)) & 63) + 48) + "\n"

    data = "".join("0O%c" % (48 + i % 60) for i in range(82))
    text = "MD0100018101000\n99b\n" + line("0001")
    for at in range(0, len(data), 64):
        text += line(data[at:at + 64])
    return text + "\nPP\n00P\n" + line("AFRT:384;")[:-2] + "6\n\n"


def witmotion(kind, words):
    data = struct.pack("<BB4h", 0x55, kind, *words)
    return data + bytes([sum(data) & 0xFF])


def rvc(index):
    body = struct.pack("<B6h3x", index, 100 * index % 18000, 0, 0, 0, 0, 1000)
    return b"\xaa\xaa" + body + bytes([sum(body) & 0xFF])


def xsens():
    items = struct.pack(">HBH", 0x1020, 2, 7) + struct.pack(">HBI", 0x1060, 4, 70000)
    items += struct.pack(">HB3f", 0x4020, 12, 0, 0, 9.8) + struct.pack(">HB3f", 0x8020, 12, 0, 0, 0.5)
    data = bytes([0xFF, 0x36, len(items)]) + items
    return b"\xfa" + data + bytes([-sum(data) & 0xFF])


def vectornav():
    body = struct.pack("<BHQ6f", 1, 0x0121, 10**9, 0, 0, 0.5, 0, 0, -9.8)
    text = "VNYMR,1.0,2.0,3.0,0.1,0.2,0.3,0.0,0.0,-9.8,0.01,0.02,0.03"
    total = 0
    for char in text:
        total ^= ord(char)
    return b"\xfa" + body + struct.pack(">H", crc16(body)) + ("$%s*%02X\r\n" % (text, total)).encode()


save("ld06", "three", b"".join(ld06(i) for i in range(3)))
save("rplidar", "standard", b"\0" + b"".join(node(i) for i in range(12)))
save("rplidar", "express", b"\x01" + b"".join(capsule(i, 84) for i in range(3)))
save("rplidar", "ultra", b"\x02" + b"".join(capsule(i, 132) for i in range(3)))
save("rplidar", "dense", b"\x03" + b"".join(capsule(i, 84) for i in range(3)))
save("rplidar", "session", b"\x04" + bytes.fromhex("A55A1400000004") + bytes(20) + bytes.fromhex("A55A0300000006000000A55A0500004081"))
save("scip", "scan", scip())
save("ydlidar", "two", b"\x01" + ydlidar(0, 2) + ydlidar(1, 2))
save("ydlidar", "three", b"\x02" + ydlidar(0, 3) + ydlidar(1, 3))
save("witmotion", "group", witmotion(0x51, (1, 2, 2048, 2500)) + witmotion(0x52, (3, 4, 5, 2500)) + witmotion(0x53, (0, 0, 9, 1)))
save("bno08x-rvc", "three", b"".join(rvc(i) for i in range(3)))
save("xsens", "imu", xsens() * 2)
save("vectornav", "both", vectornav())
save("canopen", "start", bytes.fromhex("00" "0600000100" "06000508007f000000000000" "06000608e80300000a000000"))
save("odrive", "estimates", bytes.fromhex("00" "0600000800000000080000000600010800002041000048420600020800000000080000000600030800002041000048c2"))
save("vesc", "tachometers", bytes.fromhex("0600010800000064000000f00600030800000064000000f0"))
save("dbc-wheels", "angles", bytes.fromhex("0807100100000000003fff08171001000000003fff" "060000080064006400000000"))
save("dbc-file", "body", 'BO_ 517 MOTORS_ANGLE: 8 X\n SG_ LEFT : 7|16@0+ (1,0) [0|16384] "" X\n SG_ MODE M : 16|2@1+ (1,0) [0|3] "" X\n'
     ' SG_ RATE m1 : 32|32@1- (0.5,-1) [0|1] "rev" X\nSIG_VALTYPE_ 517 RATE : 1;\nCM_ "IMPORT other.dbc";\n')
save("candump", "both", "(1.000001) can0 181#3842\ncan0 00001B01#0000006400F00000\n  can0  RX - -  1D6   [3]  00 41 2B   '.A+'\ncan0 123#R\n")
save("log", "carmen", "# made up\nFLASER 3 1.0 2.0 3.0 0.0 0.0 0.0 0.0 0.0 0.0 1.5 host 1.5\nODOM 0.1 0.2 0.3 0 0 0 1.6 host 1.6\n")
save("trajectory", "tum", "# stamp x y z qx qy qz qw\n1.0 0 0 0 0 0 0 1\n2.0 1 0 0 0 0 0.1 0.99\n")
save("config", "all", '[demo]\nseconds = 60\n[localiser]\nmin_share = 0.5\n[lidar]\ndevice = "ld06"\n')
save("map-file", "small", b"image: picolo_fuzz.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n\0P5\n2 2\n255\n\x00\xfe\xcd\x00")
save("store-map", "runs", bytes([7, 7, 63, 140, 0, 5, 3, 1, 2, 3, 4, 200, 255, 0]))
save("store-header", "blank", b"\xff" * 64)
save("sweeps", "wall", bytes([9, 128, 0, 9, 128, 0, 128, 0]) + b"".join(bytes([9, 40, i * 4, 9, 4 * i, 0]) for i in range(40)))
save("drives", "curve", b"".join(bytes([0x54, 9, 160, i, 9, 170, i, 9, 130, 0, 9, 128, 0, 9, 129, 0]) for i in range(20)))
