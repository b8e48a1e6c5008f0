// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <cmath>

#include "data/data_file.h"
#include "support/data_tables.h"
#include "support/mentions.h"

namespace orrery::data {

namespace {

using support::numbers;
using support::texts;

class DataCsv : public testing::Test {
 protected:
  std::unique_ptr<DataFile> open(const std::string& text, const std::string& name = "a.csv") {
    support::write_bytes(folder_ / name, text);
    return data::open(folder_ / name);
  }
  Table read(const std::string& text) { return support::read_table(*open(text)); }
  std::string columns(const std::string& text) { return support::columns_text(open(text)->describe(0)); }
  Roles roles(const std::string& text) { return open(text)->describe(0).roles; }
  std::string faults(const std::string& text, const std::string& name = "a.csv") {
    support::write_bytes(folder_ / name, text);
    return support::read_faults(folder_ / name);
  }
  support::TempDir folder_;
};

TEST_F(DataCsv, HeaderAndTypes) {
  const auto file = open("\xEF\xBB\xBFx,y , \"z\",name\n1,2,3,\"a, \"\"b\"\"\"\r\n-4e2,,.5,c\n");
  EXPECT_STREQ(file->format, "CSV");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(info.rows, 2u);
  EXPECT_EQ(support::columns_text(info), "x:float64 y:float64 z:float64 name:text");
  const Table table = support::read_table(*file);
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1, -400}));
  EXPECT_EQ(numbers(table, "y")[0], 2);
  EXPECT_TRUE(std::isnan(numbers(table, "y")[1])) << "missing";
  EXPECT_EQ(texts(table, "name"), (std::vector<std::string>{"a, \"b\"", "c"}));
  const Table some = file->read(0, {"name", "x"});
  EXPECT_EQ(some.columns[0].name, "name");
  EXPECT_EQ(some.columns[1].name, "x");
}

TEST_F(DataCsv, SeparatorsAreDetected) {
  for (const char* text : {"x,y,z\n1,2,3\n", "x;y;z\n1;2;3\n", "x\ty\tz\n1\t2\t3\n", "x y z\n1 2 3\n",
                           " x  y\tz \n 1 2\t\t3\n", "x, y, z\n1, 2, 3\n"})
    EXPECT_EQ(numbers(read(text), "z"), std::vector<double>{3}) << text;
  EXPECT_EQ(columns("x;y;z;n\n1;2;3;a, b\n"), "x:float64 y:float64 z:float64 n:text");
  EXPECT_EQ(columns("x\ty\tz\tn\n1\t\t3\ta; b, c\n"), "x:float64 y:float64 z:float64 n:text") << "an empty value";
  EXPECT_EQ(columns("x;y;z;a,b\n1;2;3;4,5\n"), "x:float64 y:float64 z:float64 a,b:text");
}

TEST_F(DataCsv, TheHeaderMayHaveNumbers) {
  EXPECT_EQ(columns("x,y,z,2020\n1,2,3,4\n"), "x:float64 y:float64 z:float64 2020:float64");
  EXPECT_EQ(columns("0.5 ra dec dist\n1 2 3 4\n"),
            "0.5:float64 ra:float64 dec:float64 dist:float64 x:float64 y:float64 z:float64");
}

TEST_F(DataCsv, TheHeaderMayBeAComment) {
  const std::string comments = "# made by hand\n\n% x y z q\n";
  EXPECT_EQ(columns(comments + "1 2 3 4\n"), "x:float64 y:float64 z:float64 q:float64");
  EXPECT_EQ(columns("#x,y,z\n1,2,3\n"), "x:float64 y:float64 z:float64");
  EXPECT_EQ(columns("# x y z\n1,2,3\n"), "x:float64 y:float64 z:float64") << "in another separator";
  EXPECT_EQ(columns("# x y z\nX,Y,Z\n1,2,3\n"), "X:float64 Y:float64 Z:float64") << "a header row has priority";
  EXPECT_EQ(roles(comments + "1 2 3 4\n").position[0], "x");
}

TEST_F(DataCsv, WithoutAHeaderTheFirstThreeColumnsArePositions) {
  const FrameInfo info = open("# made by hand\n1 2 3 4\n5 6 7 8\n")->describe(0);
  EXPECT_EQ(support::columns_text(info), "column1:float64 column2:float64 column3:float64 column4:float64");
  EXPECT_EQ(info.roles.position[2], "column3");
  EXPECT_EQ(info.roles.radius, "");
  EXPECT_EQ(info.rows, 2u);
  EXPECT_EQ(
      faults("Ar 1 2 3\nAr 4 5 6\n"),
      "1: there are neither columns x, y and z of numbers nor ra, dec and distance (or parallax); the columns are: "
      "column1, column2, column3, column4; add a header line with the names of the columns\n");
}

TEST_F(DataCsv, AByteOrderMarkIsSkipped) {
  EXPECT_EQ(numbers(read(std::string("\xEF\xBB\xBF") + "1,2,3\n4,5,6\n"), "column1"), (std::vector<double>{1, 4}));
}

TEST_F(DataCsv, RolesByCustomaryNames) {
  const Roles by_name = roles("ID,X,Y,Z,Diameter,Type,Element,Red,Green,Blue\n1,0,0,0,2,3,He,0,128,255\n");
  EXPECT_EQ(by_name.position, (std::array<std::string, 3>{"X", "Y", "Z"}));
  EXPECT_EQ(by_name.radius, "Diameter");
  EXPECT_EQ(by_name.radius_scale, 0.5);
  EXPECT_EQ(by_name.type, "Type");
  EXPECT_EQ(by_name.element, "Element");
  EXPECT_EQ(by_name.id, "ID");
  EXPECT_EQ(by_name.rgb[1], "Green");
  EXPECT_EQ(by_name.rgb_maximum, 255);
  EXPECT_EQ(roles("x,y,z,r\n1,2,3,4\n").radius, "r");
  const Roles color = roles("x,y,z,r,g,b,class\n1,2,3,0.5,1,0,rock\n");
  EXPECT_EQ(color.radius, "");
  EXPECT_EQ(color.rgb[0], "r");
  EXPECT_EQ(color.rgb_maximum, 1);
  EXPECT_EQ(color.type, "class");
  EXPECT_EQ(roles("x,y,z,r,g,b\n1,2,3,256,1,0\n").rgb_maximum, 65535);
  EXPECT_EQ(roles("x,y,z,element\n1,2,3,4\n").element, "") << "an element is a text";
  EXPECT_EQ(roles("Points:0,Points:1,Points:2\n1,2,3\n").position[1], "Points:1") << "of ParaView";
}

TEST_F(DataCsv, EquatorialCoordinatesBecomePositions) {
  const auto file = open("name,RA,Dec,distance\na,0,0,2\nb,90,0,3\nc,45,90,4\nd,0,-90,\n");
  const FrameInfo info = file->describe(0);
  EXPECT_EQ(support::columns_text(info),
            "name:text RA:float64 Dec:float64 distance:float64 x:float64 y:float64 z:float64");
  EXPECT_EQ(info.roles.position[2], "z");
  const Table table = file->read(0, {"x", "y", "z"});
  ASSERT_EQ(table.columns.size(), 3u);
  const auto x = numbers(table, "x"), y = numbers(table, "y"), z = numbers(table, "z");
  const double expected[][3] = {{2, 0, 0}, {0, 3, 0}, {0, 0, 4}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(x[i], expected[i][0], 1e-15);
    EXPECT_NEAR(y[i], expected[i][1], 1e-15);
    EXPECT_NEAR(z[i], expected[i][2], 1e-15);
  }
  EXPECT_TRUE(std::isnan(x[3]) && std::isnan(z[3])) << "no distance";
  EXPECT_EQ(support::read_table(*file).columns.size(), 7u);
}

TEST_F(DataCsv, ParallaxesAreMilliarcseconds) {
  const Table table = read("ra,dec,parallax\n0,0,100\n0,0,0\n0,0,-1\n");
  EXPECT_EQ(numbers(table, "x")[0], 10);
  EXPECT_TRUE(std::isnan(numbers(table, "x")[1]));
  EXPECT_TRUE(std::isnan(numbers(table, "x")[2]));
  EXPECT_EQ(numbers(read("ra,dec,parallax,distance\n0,0,100,7\n"), "x")[0], 7) << "a distance has priority";
  EXPECT_EQ(numbers(read("ra,dec,distance,x,y,z\n0,0,100,7,8,9\n"), "x")[0], 7) << "positions have priority";
  EXPECT_EQ(numbers(read("ra,dec,distance,x\n0,0,100,7\n"), "x_2")[0], 100);
  EXPECT_NE(faults("ra,dec\n1,2\n"), "");
}

TEST_F(DataCsv, ATextInAColumnOfNumbersIsAnErrorWithItsLine) {
  std::string text = "# comment\nx,y,z\n";
  for (int i = 0; i < 1500; ++i) text += "1,2,3\n";
  EXPECT_EQ(faults(text), "");
  EXPECT_TRUE(test::mentions(faults(text + "1,two,3\n1,three,3\n"), {"1503", "column", "two", "number", "empty"}));
  EXPECT_EQ(faults(text + "1,2\n"), "1503: the row has 2 values, not 3\n");
  EXPECT_TRUE(test::mentions(faults(text + "1,2,3,4\n"), {"1503", "3"}));
  EXPECT_TRUE(test::mentions(faults("x,y,z\n1%,2,3\n"), {"2", "column", "x", "1%", "number"})) << "no number at all";
  EXPECT_EQ(columns("x,y,z,q\n1,2,3,4\n1,2,3,none\n"), "x:float64 y:float64 z:float64 q:text");
}

/// One word must not turn radii or colours into strings, which would be replaced by defaults.
TEST_F(DataCsv, AWordInAColumnWithAMeaningIsAnError) {
  EXPECT_TRUE(
      test::mentions(faults("x,y,z,radius\n0,0,0,1\n1,0,0,broken\n"), {"3", "column", "4", "broken", "number"}));
  EXPECT_EQ(roles("x,y,z,radius\n0,0,0,1\n1,0,0,broken\n").radius, "radius") << "until it is read";
  EXPECT_EQ(numbers(open("x,y,z,radius\n0,0,0,1\n1,0,0,broken\n")->read(0, {"x"}), "x")[1], 1) << "if it is not needed";
  EXPECT_TRUE(
      test::mentions(faults("x,y,z,red,green,blue\n0,0,0,1,0,?\n0,0,0,1,0,0\n"), {"2", "column", "6", "?", "number"}));
  EXPECT_TRUE(test::mentions(faults("ra,dec,parallax\n1,2,3\n1,2,-\n"), {"3", "column", "-", "number", "empty"}));
  EXPECT_EQ(columns("x,y,z,radius\n0,0,0,small\n"), "x:float64 y:float64 z:float64 radius:text") << "no number at all";
}

TEST_F(DataCsv, DecimalCommasAreNamed) {
  const std::string remedy = "write numbers with decimal points instead of decimal commas\n";
  EXPECT_EQ(faults("x;y;z\n1,5;2;3\n"), "2: column x: '1,5' is not a number; " + remedy);
  EXPECT_EQ(faults("x y z\n1 2 3\n1 -2,5e3 3\n"), "3: column y: '-2,5e3' is not a number; " + remedy);
  EXPECT_EQ(faults("x,y,z\n1,2,\"3,5\"\n"), "2: column z: '3,5' is not a number; " + remedy);
  EXPECT_NE(faults("1,5;2,5;3,5\n4,5;5,5;6,5\n").find(remedy), std::string::npos) << "without a header";
  EXPECT_EQ(faults("x;y;z;tag\n1;2;3;1,5\n"), "") << "not needed as a number";
}

/// Of elements, only if all are.
TEST_F(DataCsv, NamesThatAreNotElementsAreTypes) {
  EXPECT_EQ(roles("x,y,z,species\n0,0,0,C\n1,0,0,h\n").element, "species");
  EXPECT_EQ(roles("x,y,z,species\n0,0,0,C\n1,0,0,C1\n").element, "");
  EXPECT_EQ(roles("x,y,z,species\n0,0,0,C\n1,0,0,C1\n").type, "species");
  EXPECT_EQ(roles("x,y,z,species,type\n0,0,0,setosa,1\n").type, "type");
}

TEST_F(DataCsv, MarkersOfMissingValuesAreNan) {
  for (const std::string marker : {"NA", "N/A", "n/a", "#N/A", "<NA>", "null", "NULL", "None", ""}) {
    const Table table = read("x,y,z,radius\n0,0,0,0.5\n0,0,0," + marker + "\n0,0,0,2\n");
    EXPECT_EQ(numbers(table, "radius")[0], 0.5);
    EXPECT_TRUE(std::isnan(numbers(table, "radius")[1])) << marker;
    EXPECT_EQ(numbers(table, "radius")[2], 2);
  }
  EXPECT_TRUE(std::isnan(numbers(read("x y z q\n1 2 3 4\n1 2 3 NA\n"), "q")[1])) << "separated by blanks";
  EXPECT_EQ(columns("x,y,z,element\n1,2,3,NA\n"), "x:float64 y:float64 z:float64 element:text") << "no number";
}

/// A scan may begin with a million rows without colours.
TEST_F(DataCsv, TheWholeFileDeterminesTypesAndRanges) {
  std::string colors = "x,y,z,red,green,blue\n", ids = "x,y,z,id\n", words = "x,y,z,note\n";
  for (int i = 0; i < 2000; ++i) {
    colors += "0,0,0,0,0,0\n";
    ids += "0,0,0,1\n";
    words += "0,0,0,\n";
  }
  EXPECT_EQ(roles(colors + "0,0,0,200,100,50\n").rgb_maximum, 255);
  EXPECT_EQ(roles(colors + "0,0,0,30000,100,50\n").rgb_maximum, 65535);
  const auto file = open(ids + "0,0,0,9007199254740993\n");
  EXPECT_EQ(support::columns_text(file->describe(0)), "x:float64 y:float64 z:float64 id:int64");
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(file->read(0, {"id"}).columns[0].values).back(), 9007199254740993);
  EXPECT_EQ(texts(read(words + "0,0,0,binary\n"), "note").back(), "binary");
  EXPECT_EQ(columns("x,y,z,id\n0,0,0,9007199254740993\n0,0,0,\n"), "x:float64 y:float64 z:float64 id:float64")
      << "an int64 cannot be missing";
  EXPECT_EQ(columns("x,y,z,n\n\"1\",\"2\",\"3\",\"4\"\n\"1\",\"2\",\"3\",\n"),
            "x:float64 y:float64 z:float64 n:float64")
      << "an empty value needs no quotes";
  EXPECT_EQ(columns(words + "0,0,0,\"1\"\n"), "x:float64 y:float64 z:float64 note:text") << "quoted, unlike the others";
}

TEST_F(DataCsv, CommentsAreSkippedAnywhere) {
  const Table table = read("# first\nx,y,z\n1,2,3\n# between\n  % indented\n4,5,6\n# last\n");
  EXPECT_EQ(numbers(table, "x"), (std::vector<double>{1, 4}));
  EXPECT_EQ(numbers(read("1 2 3\n# between\n4 5 6\n"), "column3"), (std::vector<double>{3, 6}));
  EXPECT_TRUE(
      test::mentions(faults("x,y,z\n# comment\n1,2,three\n1,2,3\n"), {"3", "column", "three", "number", "empty"}))
      << "comments count as lines";
  EXPECT_EQ(texts(read("color,x,y,z\n#ff0000,1,2,3\n#00ff00,2,3,4\n"), "color"),
            (std::vector<std::string>{"#ff0000", "#00ff00"}));
  EXPECT_TRUE(test::mentions(faults("x,y,z\n1,2,3\n#4,5,6\n"), {"3", "column", "#4", "number", "empty"}));
  EXPECT_EQ(roles("//X Y Z R G B\n1 2 3 255 0 0\n").rgb[0], "R") << "of CloudCompare";
}

TEST_F(DataCsv, QuotedColumnsAreStringsUnlessAllAreQuoted) {
  EXPECT_EQ(columns("x,y,z,chain\n1,2,3,\"1\"\n1,2,3,\"2\"\n"), "x:float64 y:float64 z:float64 chain:text");
  EXPECT_EQ(columns("x,y,z,chain\n1,2,3,\"1\"\n1,2,3,2\n"), "x:float64 y:float64 z:float64 chain:float64");
  EXPECT_EQ(columns("\"x\",\"y\",\"z\"\n\"1\",\"2\",\"3\"\n"), "x:float64 y:float64 z:float64");
}

TEST_F(DataCsv, LargeIntegersAreInt64) {
  const auto file =
      open("x,y,z,id,n,m\n1,2,3,4295806720,9007199254740992,9007199254740993\n1,2,3,-9223372036854775807,1,2\n");
  EXPECT_EQ(support::columns_text(file->describe(0)), "x:float64 y:float64 z:float64 id:int64 n:float64 m:int64");
  EXPECT_EQ(std::get<std::vector<std::int64_t>>(file->read(0, {"id"}).columns[0].values),
            (std::vector<std::int64_t>{4295806720, -9223372036854775807}));
}

TEST_F(DataCsv, NamesAreUnique) {
  EXPECT_EQ(columns("x,y,z,,x,x_2\n1,2,3,4,5,6\n"),
            "x:float64 y:float64 z:float64 column4:float64 x_2:float64 x_2_2:float64");
}

TEST_F(DataCsv, FilesWithoutRows) {
  EXPECT_EQ(open("x,y,z\n")->describe(0).rows, 0u);
  EXPECT_TRUE(test::mentions(faults("# nothing\n"), {"rows"}));
  EXPECT_EQ(faults("a,b\n1,2\n").rfind("2: there are neither", 0), 0u);
}

TEST_F(DataCsv, TextFilesAreRecognisedByTheirContent) {
  EXPECT_STREQ(open("x y z\n1 2 3\n", "a.txt")->format, "CSV");
  EXPECT_STREQ(open("ra,dec,dist\n1,2,3\n", "a.dat")->format, "CSV");
  EXPECT_STREQ(open("1 2 3\n4 5 6", "a.asc")->format, "CSV");
  for (const char* text : {"hello world\n", "1 2\n3 4\n", "a b c\n1 2 3\n", "some text of many words\nand more\n"})
    EXPECT_EQ(faults(text, "a.txt").rfind("unknown file format", 0), 0u) << text;
  EXPECT_EQ(faults(std::string("x y z\n1 2 3\n\0", 13), "a.bin").rfind("unknown file format", 0), 0u);
}

TEST_F(DataCsv, TooManyColumnsAreRefused) {
  std::string header = "x,y,z";
  for (int i = 0; i < 4094; ++i) header += ",a" + std::to_string(i);
  EXPECT_TRUE(test::mentions(faults(header + "\n"), {"2", "4096", "columns"}));
}

}  // namespace
}  // namespace orrery::data
