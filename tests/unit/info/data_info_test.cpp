// SPDX-License-Identifier: Apache-2.0
#include "info/data_info.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include <nlohmann/json.hpp>

#include "base/error.h"
#include "support/temp_dir.h"

namespace orrery::info {
namespace {

constexpr const char* kDump =
    "ITEM: TIMESTEP\n100\nITEM: NUMBER OF ATOMS\n0\nITEM: BOX BOUNDS pp pp ff\n0 4\n0 5\n-1 5\n"
    "ITEM: ATOMS id type element diameter x y z ix iy iz vx vy vz\n"
    "ITEM: TIMESTEP\n200\nITEM: NUMBER OF ATOMS\n3\nITEM: BOX BOUNDS pp pp ff\n0 4\n0 5\n-1 5\n"
    "ITEM: ATOMS id type element diameter x y z ix iy iz vx vy vz\n"
    "7 1 C 0.5 1.5 2 3 0 0 0 1 0 nan\n"
    "9007199254740993 2 Ar 1.25 -1e-9 2 3 0 -1 0 2 0 inf\n"
    "8 1 C 0.5 1.5 2 3 1 0 0 3 0 -4\n";

class InfoDataInfo : public testing::Test {
 protected:
  DataInfo info(const std::string& name, const std::string& bytes, DataInfoRequest request = {}) {
    support::write_bytes(folder_ / name, bytes);
    request.file = folder_ / name;
    DataInfo out = data_info(request);
    out.file = name;
    return out;
  }
  nlohmann::json json(const std::string& name, const std::string& bytes, DataInfoRequest request = {}) {
    return nlohmann::json::parse(data_info_json(info(name, bytes, std::move(request))));
  }

  support::TempDir folder_;
};

TEST_F(InfoDataInfo, TellsTheValuesOfAColumn) {
  support::write_bytes(folder_ / "a.dump", kDump);
  DataInfoRequest request;
  request.file = folder_ / "a.dump";
  request.frame = 2;
  const auto values = [&](const char* column, bool is_log = false) {
    return nlohmann::json::parse(column_values_json(request, column, is_log));
  };
  const nlohmann::json x = values("x");
  EXPECT_EQ(x["low"], -1e-9);
  EXPECT_EQ(x["high"], 1.5);
  EXPECT_EQ(x["bins"].size(), 64u);
  EXPECT_EQ(x["bins"][0], 1);
  EXPECT_EQ(x["bins"][63], 2);
  EXPECT_EQ(x["classes"][0], nlohmann::json({"1.5", 2}));
  EXPECT_EQ(values("x", true)["low"], 1.5) << "logarithms have values above 0";
  EXPECT_EQ(values("element")["classes"].dump(), R"([["C",2],["Ar",1]])");
  const nlohmann::json vz = values("vz");
  EXPECT_EQ(vz["nan"], 1);
  EXPECT_EQ(vz["high"], -4) << "infinity has no place in a histogram";
  EXPECT_EQ(values("speed")["low"], 5) << "a column that is computed";
  EXPECT_THROW(values("nothing"), base::Error);
  request.frame = 3;
  EXPECT_THROW(values("x"), base::Error);
}

TEST_F(InfoDataInfo, HasTheMostFrequentOfManyClasses) {
  std::string bytes = "x,y,z,name\n";
  for (int i = 0; i < 5000; ++i)
    bytes += "0,0," + std::to_string(i) + ",<b>" + std::to_string(std::min(i, 4000)) + "\n";
  support::write_bytes(folder_ / "a.csv", bytes);
  DataInfoRequest request;
  request.file = folder_ / "a.csv";
  const auto names = nlohmann::json::parse(column_values_json(request, "name", false));
  EXPECT_EQ(names["distinct"], 4001);
  EXPECT_EQ(names["classes"].size(), 200u);
  EXPECT_EQ(names["classes"][0], nlohmann::json({"<b>4000", 1000}));
  EXPECT_FALSE(nlohmann::json::parse(column_values_json(request, "z", false)).contains("classes"));
}

TEST_F(InfoDataInfo, DescribesAFrame) {
  DataInfoRequest request;
  request.frame = 2;
  EXPECT_EQ(
      data_info_text(info("a.dump", kDump, request)),
      "file        a.dump\n"
      "format      LAMMPS dump\n"
      "frame       2 of 2, step 200\n"
      "rows        3\n"
      "box         origin (0, 0, -1), edges a (4, 0, 0), b (0, 5, 0), c (0, 0, 6), periodic along a, b\n"
      "roles       position x, y, z; radius diameter times 0.5; element element; type type; id id; image ix, iy, iz\n"
      "computed    speed, from vx, vy, vz\n"
      "columns     name      type     minimum  maximum           NaN\n"
      "            id        int64    7        9007199254740993  0\n"
      "            type      int64    1        2                 0\n"
      "            element   text     2 distinct: C, Ar\n"
      "            diameter  float64  0.5      1.25              0\n"
      "            x         float64  -1e-09   1.5               0\n"
      "            y         float64  2        2                 0\n"
      "            z         float64  3        3                 0\n"
      "            ix        int64    0        1                 0\n"
      "            iy        int64    -1       0                 0\n"
      "            iz        int64    0        0                 0\n"
      "            vx        float64  1        3                 0\n"
      "            vy        float64  0        0                 0\n"
      "            vz        float64  -4       -4                1, 1 infinite\n");
}

TEST_F(InfoDataInfo, FrameWithoutParticlesHasNoValues) {
  const std::string text = data_info_text(info("a.dump", kDump));
  EXPECT_NE(text.find("\nframe       1 of 2, step 100\nrows        0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("            x         float64  -        -        0\n"), std::string::npos) << text;
  EXPECT_NE(text.find("            element   text     0 distinct:\n"), std::string::npos) << text;
  const nlohmann::json all = json("a.dump", kDump);
  EXPECT_EQ(all["columns"][0]["minimum"], nullptr);
}

TEST_F(InfoDataInfo, JsonHasEverything) {
  DataInfoRequest request;
  request.frame = 2;
  const nlohmann::json all = json("a.dump", kDump, request);
  EXPECT_EQ(all["schema"], "orrery.data/1");
  EXPECT_EQ(all["file"], "a.dump");
  EXPECT_EQ(all["format"], "LAMMPS dump");
  EXPECT_EQ(all["frames"], 2);
  EXPECT_EQ(all["frame"], 2);
  EXPECT_EQ(all["step"], 200);
  EXPECT_EQ(all["rows"], 3);
  EXPECT_EQ(all["assemblies"], nlohmann::json::array());
  EXPECT_EQ(all["box"], nlohmann::json::parse(R"({"origin": [0, 0, -1], "edges": [[4, 0, 0], [0, 5, 0], [0, 0, 6]],
                                                  "periodic": [true, true, false]})"));
  EXPECT_EQ(all["roles"], nlohmann::json::parse(R"({"position": ["x", "y", "z"], "element": "element", "type": "type",
      "id": "id", "chain": null, "rgb": null, "image": ["ix", "iy", "iz"],
      "radius": {"column": "diameter", "scale": 0.5}})"));
  EXPECT_EQ(all["computed"], nlohmann::json::parse(R"([{"name": "speed", "columns": ["vx", "vy", "vz"]}])"));
  ASSERT_EQ(all["columns"].size(), 13u);
  EXPECT_EQ(all["columns"][0], nlohmann::json::parse(R"({"name": "id", "type": "int64", "minimum": 7,
      "maximum": 9007199254740993, "nan": 0, "infinite": 0})"))
      << "an integer that is no float64";
  EXPECT_EQ(all["columns"][2],
            nlohmann::json::parse(R"({"name": "element", "type": "text", "distinct": 2, "values": ["C", "Ar"]})"));
  EXPECT_EQ(all["columns"][12], nlohmann::json::parse(R"({"name": "vz", "type": "float64", "minimum": -4, "maximum": -4,
      "nan": 1, "infinite": 1})"));
}

TEST_F(InfoDataInfo, ColumnsCanBeReadOneByOne) {
  DataInfoRequest request;
  request.frame = 2;
  const std::string together = data_info_json(info("a.dump", kDump, request));
  for (const std::uint64_t bytes : {1, 30, 60}) {  // one column, one of 24 bytes and one of 12, two of 24
    request.table_bytes = bytes;
    EXPECT_EQ(data_info_json(info("a.dump", kDump, request)), together) << bytes;
  }
}

TEST_F(InfoDataInfo, ManyAndUnusualStrings) {
  std::string csv = "x,y,z,t\n";
  for (int i = 0; i < 10; ++i) csv += "1,2,3,\"w" + std::to_string(i) + "\"\n";
  std::string text = data_info_text(info("a.csv", csv));
  EXPECT_NE(text.find("10 distinct: w0, w1, w2, w3, w4, w5, w6, w7, ...\n"), std::string::npos) << text;
  csv = "x,y,z,t\n1,2,3,\"\"\n1,2,3,\"\x1b[31m\"\n1,2,3,\"" + std::string(31, 'a') + "\xc3\xa4\"\n1,2,3,\"\xff\"\n";
  text = data_info_text(info("a.csv", csv));
  EXPECT_NE(text.find("4 distinct: \"\", \\x1b[31m, " + std::string(31, 'a') + "..., "), std::string::npos) << text;
  EXPECT_EQ(json("a.csv", csv)["columns"][3]["values"][3], "\xEF\xBF\xBD") << "JSON is UTF-8";
}

TEST_F(InfoDataInfo, AssembliesAndTitle) {
  const std::string pdb =
      "HEADER    TEST\nTITLE     A TITLE\n"
      "REMARK 350 BIOMOLECULE: 1\nREMARK 350 APPLY THE FOLLOWING TO CHAINS: A\n"
      "REMARK 350   BIOMT1   1  1.000000  0.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT2   1  0.000000  1.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT3   1  0.000000  0.000000  1.000000        0.00000\n"
      "REMARK 350   BIOMT1   2  1.000000  0.000000  0.000000        5.00000\n"
      "REMARK 350   BIOMT2   2  0.000000  1.000000  0.000000        0.00000\n"
      "REMARK 350   BIOMT3   2  0.000000  0.000000  1.000000        0.00000\n"
      "ATOM      1  N   ALA A   1       1.000   2.000   3.000  1.00  0.00           N\nEND\n";
  const DataInfo found = info("a.pdb", pdb);
  const std::string text = data_info_text(found);
  EXPECT_NE(text.find("\ntitle       A TITLE\n"), std::string::npos) << text;
  EXPECT_NE(text.find("\nassemblies  1 (2 copies)\n"), std::string::npos) << text;
  EXPECT_EQ(nlohmann::json::parse(data_info_json(found))["assemblies"],
            nlohmann::json::parse(R"([{"name": "1", "copies": 2}])"));
}

TEST_F(InfoDataInfo, FramesThatAFileDoesNotHaveAreRefused) {
  for (const int frame : {0, 3}) {
    DataInfoRequest request;
    request.frame = frame;
    try {
      info("a.dump", kDump, request);
      ADD_FAILURE() << frame;
    } catch (const base::Error& error) {
      EXPECT_EQ(error.kind(), base::ErrorKind::kUsage);
      EXPECT_NE(std::string(error.what()).find("a.dump has 2 frames"), std::string::npos) << error.what();
    }
  }
}

}  // namespace
}  // namespace orrery::info
