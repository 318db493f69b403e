// SPDX-FileCopyrightText: picolo contributors
// SPDX-License-Identifier: Apache-2.0
// make_corpus FOLDER: writes the seeds of the fuzz targets: packets and texts made up here and in
// tests/drivers/wire_faults, none recorded. The committed corpus is what it writes (ctest -R
// fuzz.corpus).
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

#include "picolo/drivers/scip/scip_text.hpp"
#include "support/bytes.hpp"
#include "wires.hpp"

namespace picolo::test {
namespace {

class Corpus {
 public:
  explicit Corpus(std::filesystem::path root) : root_(std::move(root)) {}

  void save(const std::string& target, const std::string& name, const Bytes& bytes) const {
    std::filesystem::create_directories(root_ / target);
    std::ofstream file{root_ / target / name, std::ios::binary};
    for (const std::uint8_t byte : bytes) { file.put(static_cast<char>(byte)); }
    if (!file.flush()) { throw std::runtime_error((root_ / target / name).string()); }
  }
  void save(const std::string& target, const std::string& name, const std::string& text) const {
    save(target, name, Bytes{text.begin(), text.end()});
  }

 private:
  std::filesystem::path root_;
};

/// The first packets of a protocol, behind a byte that chooses among the variants of a target.
Bytes packets(const std::string& wire_name, std::uint32_t count, const Bytes& choice = {}) {
  for (const Wire& wire : all_wires()) {
    if (wire.name != wire_name) { continue; }
    Bytes stream = choice;
    for (std::uint32_t i = 0; i < count; ++i) { stream = join({stream, wire.packet(i)}); }
    return stream;
  }
  throw std::invalid_argument("no wire " + wire_name);
}

Bytes text_line(const std::string& text) {
  Bytes bytes{text.begin(), text.end()};
  bytes.push_back(scip_sum(bytes));
  return join({bytes, Bytes{'\n'}});
}

void serial(const Corpus& corpus) {
  corpus.save("ld06", "three", packets("ld06", 3));
  corpus.save("rplidar", "standard", packets("rplidar 0x81", 12, {0}));
  corpus.save("rplidar", "express", packets("rplidar 0x82", 3, {1}));
  corpus.save("rplidar", "ultra", packets("rplidar 0x84", 3, {2}));
  corpus.save("rplidar", "dense", packets("rplidar 0x85", 3, {3}));
  corpus.save("rplidar", "session",
              join({from_hex("04A55A1400000004"), Bytes(20),
                    from_hex("A55A0300000006000000A55A0500004081")}));
  corpus.save("scip", "scan", packets("scip", 2));
  corpus.save("scip", "session",
              join({text_line("PP"), text_line("00"), text_line("ARES:450"), text_line("")}));
  corpus.save("ydlidar", "two", packets("ydlidar", 2, {1}));
  corpus.save("ydlidar", "three",  // one packet of two samples with intensities
              from_hex("02AA550002011101194650804050408050"));
  corpus.save("witmotion", "three", packets("witmotion", 3));
  corpus.save("bno08x-rvc", "three", packets("bno08x-rvc", 3));
  corpus.save("xsens", "three", packets("xsens", 3));
  corpus.save("vectornav", "both",
              join({packets("vectornav bin", 2), packets("vectornav text", 2)}));
}

void can(const Corpus& corpus) {
  corpus.save("canopen", "start",
              from_hex("00060000010006000508007f00000000000006000608e80300000a000000"));
  corpus.save("odrive", "estimates",
              from_hex("00060000080000000008000000060001080000204100004842"
                       "0600020800000000080000000600030800002041000048c2"));
  corpus.save("vesc", "tachometers", from_hex("0600010800000064000000f00600030800000064000000f0"));
  // z, frames of every kind, a refusal and a version, in two pieces.
  corpus.save("slcan", "lines",
              from_hex("01001c0d7a0d7431323332313132320d543141424344454630314141"
                       "0d011872313233340d0756313031330d74374646383030313132320d"));
  corpus.save("dbc-wheels", "angles",
              from_hex("0807100100000000003fff08171001000000003fff060000080064006400000000"));
}

void text(const Corpus& corpus) {
  corpus.save("dbc-file", "body",
              "BO_ 517 MOTORS_ANGLE: 8 X\n SG_ LEFT : 7|16@0+ (1,0) [0|16384] \"\" X\n"
              " SG_ MODE M : 16|2@1+ (1,0) [0|3] \"\" X\n"
              " SG_ RATE m1 : 32|32@1- (0.5,-1) [0|1] \"rev\" X\nSIG_VALTYPE_ 517 RATE : 1;\n"
              "CM_ \"IMPORT other.dbc\";\n");
  corpus.save("candump", "both",
              "(1.000001) can0 181#3842\ncan0 00001B01#0000006400F00000\n"
              "  can0  RX - -  1D6   [3]  00 41 2B   '.A+'\ncan0 123#R\n");
  corpus.save("log", "carmen",
              "# made up\nFLASER 3 1.0 2.0 3.0 0.0 0.0 0.0 0.0 0.0 0.0 1.5 host 1.5\n"
              "ODOM 0.1 0.2 0.3 0 0 0 1.6 host 1.6\n");
  corpus.save("trajectory", "tum",
              "# stamp x y z qx qy qz qw\n1.0 0 0 0 0 0 0 1\n2.0 1 0 0 0 0 0.1 0.99\n");
  corpus.save("config", "demo",
              "[demo]\nseconds = 60\n[localiser]\nmin_share = 0.5\n[lidar]\ndevice = \"ld06\"\n");
  corpus.save("config", "vehicle",
              "[vehicle]\nprofile = \"site\"\ntrack_m = 0.5\n[wheels]\ndriver = \"odrive\"\n"
              "left_id = 3\nleft_inverted = true\n[lidar]\ndriver = \"rplidar\"\nbaud = 256000\n"
              "[imu]\npresent = false\n[can]\nbase_id = 272\n[cycle]\nminor_frame_ms = 5\n");
  corpus.save("map-file", "small",
              std::string{"image: picolo_fuzz.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\n"
                          "occupied_thresh: 0.65\nfree_thresh: 0.196\n"} +
                  std::string{"\0P5\n2 2\n255\n\0\xfe\xcd\0", 16});
}

void stores_and_algorithms(const Corpus& corpus) {
  corpus.save("store-map", "runs", Bytes{7, 7, 63, 140, 0, 5, 3, 1, 2, 3, 4, 200, 255, 0});
  corpus.save("store-header", "blank", Bytes(64, 0xFF));
  Bytes wall{9, 128, 0, 9, 128, 0, 128, 0};
  for (std::uint8_t i = 0; i < 40; ++i) {
    const auto along = static_cast<std::uint8_t>(i * 4);
    wall = join({wall, {9, 40, along, 9, along, 0}});
  }
  corpus.save("sweeps", "wall", wall);
  Bytes curve;
  for (std::uint8_t i = 0; i < 20; ++i) {
    curve = join({curve, {0x54, 9, 160, i, 9, 170, i, 9, 130, 0, 9, 128, 0, 9, 129, 0}});
  }
  corpus.save("drives", "curve", curve);
}

}  // namespace
}  // namespace picolo::test

int main(int argc, char** argv) {
  using namespace picolo::test;
  if (argc != 2) {
    std::fprintf(stderr, "usage: make_corpus FOLDER\n");
    return 2;
  }
  try {
    const Corpus corpus{argv[1]};
    serial(corpus);
    can(corpus);
    text(corpus);
    stores_and_algorithms(corpus);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "make_corpus: %s\n", error.what());
    return 1;
  }
  return 0;
}
