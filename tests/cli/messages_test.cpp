// SPDX-License-Identifier: Apache-2.0
// Error messages: exit status and what they name. The golden messages show the form of each kind.
#include <string_view>
#include <vector>

#include "cli/program.h"
#include "support/mentions.h"

namespace orrery::test {
namespace {

struct GoldenCase {
  const char* arguments;
  int status;
  const char* message;  ///< all of stderr
};

const GoldenCase kGolden[] = {
    {"rendr good.toml", 2,
     "orrery: unknown command rendr; did you mean `render`?\n"
     "Try orrery --help.\n"},
    {"render good.toml -o a.png --samlpes 3", 2,
     "orrery: unknown option --samlpes; did you mean `--samples`?\n"
     "Try orrery render --help.\n"},
    {"render good.toml", 2,
     "orrery: --output is required\n"
     "Try orrery render --help.\n"},
    {"render good.toml -o a.png -t many", 2,
     "orrery: --threads: must be an integer from 1 to 4096, not `many`\n"
     "Try orrery render --help.\n"},
    {"develop a.exr -o a.png --exposure", 2,
     "orrery: --exposure needs a value\n"
     "Try orrery develop --help.\n"},
    {"render good.toml -o a.png --progress jsno", 2,
     "orrery: --progress: unknown value `jsno`; did you mean `json`?\n"
     "Try orrery render --help.\n"},
    {"render good.toml -o a.png --stats good.toml", 2,
     "orrery: good.toml (--stats) would overwrite good.toml (scene); choose another name\n"},
    {"render none.toml -o a.png", 66, "orrery: cannot open none.toml: No such file or directory\n"},
    {"render good.toml -o none/a.png", 73, "orrery: cannot create none/a.png: directory none does not exist\n"},
    {"render good.toml -o a.png --samples 1 --samples 2", 2,
     "orrery: --samples is given 2 times: `1`, `2`; give it once\n"},
    {"check good.toml > /dev/full", 74, "orrery: writing to standard output failed: No space left on device\n"},
    {"compare a.exr b.exr --fail-above rsme=1", 2,
     "orrery: --fail-above rsme=1: unknown metric; did you mean `rmse`?\n"},
};

struct FactCase {
  const char* arguments;
  int status;
  std::vector<std::string_view> facts;  ///< of the message, in this order
};

const FactCase kFacts[] = {
    {"", 2, {"command", "generate"}},
    {"good.toml", 2, {"command", "good.toml", "good.toml -o image.png"}},
    {"render -o a.png", 2, {"SCENE", "required"}},
    {"render good.toml -o a.png b.png", 2, {"unexpected", "`b.png`", "-o"}},
    {"develop a.exr -o a.png --exposure bright", 2, {"--exposure", "-100", "100", "`bright`"}},
    {"render good.toml -o a.png --quiet=maybe", 2, {"--quiet", "takes", "value"}},
    {"render good.toml -o a.exr --compression zipp", 2, {"compression", "`zip`", "dwaa:45"}},
    {"render good.toml -o a.jpg --bits 16", 2, {"a.jpg", "8", "16"}},
    {"render good.toml -o a.png -o ./a.png", 2, {"./a.png", "a.png", "another"}},
    {"info good.toml --json --settings", 2, {"--json", "excludes", "--settings"}},
    {"plot a.xyz -o a.png --up x --up y", 2, {"--up", "2", "`x`", "`y`"}},
    {"convert a.xyz -o a.ply -o b.ply", 2, {"--output", "2", "`a.ply`", "`b.ply`"}},
    {"generate cloud -o a.toml --seed 1 --seed 1", 2, {"--seed", "2", "`1`", "`1`"}},
    {"submit good.toml --slurm -o a.exr --noise 0.1 --noise 0.2", 2, {"--noise", "2", "`0.1`", "`0.2`"}},
    {"info good.toml > /dev/full", 74, {"writing", "standard"}},
    {"--version > /dev/full", 74, {"writing", "standard"}},
    {"generate", 2, {"command", "given"}},
    {"generate fianl -o a.toml", 2, {"command", "fianl", "`final`"}},
    {"generate final -o a.toml --grid -3", 2, {"--grid", "0", "1000", "`-3`"}},
    {"develop a.png -o b.png", 2, {"a.png", "already", "input"}},
    {"develop none.exr -o b.png", 66, {"none.exr", "directory"}},
    {"compare none.exr none.exr", 66, {"none.exr", "directory"}},
    {"compare a.png b.exr", 2, {"b.exr", "develop", "b.exr -o developed.png"}},
    {"compare a.exr b.exr --fail-above rmse", 2, {"--fail-above", "METRIC=VALUE", "rmse=0.001"}},
    {"compare a.exr b.exr --fail-above rmse=-1", 2, {"--fail-above rmse=-1", "number", "0"}},
    {"compare a.exr b.exr --fail-above psnr=40", 2, {"--fail-above psnr=40", "decreases", "instead"}},
};

class CliMessages : public ProgramTest {
 protected:
  /// A case's own redirection comes last on the command line, so it overrides the test's.
  Outcome outcome_of(const std::string& arguments) {
    const std::size_t to = arguments.find(" > ");
    return to == std::string::npos ? run(arguments)
                                   : run(arguments.substr(0, to) + " 2>.err" + arguments.substr(to) + " #");
  }
};

TEST_F(CliMessages, MatchTheGoldenText) {
  for (const GoldenCase& c : kGolden) {
    const Outcome r = outcome_of(c.arguments);
    EXPECT_EQ(r.status, c.status) << c.arguments;
    EXPECT_EQ(r.err, c.message);
    EXPECT_EQ(file_count(), 0) << c.arguments;
  }
}

TEST_F(CliMessages, NameTheFacts) {
  for (const FactCase& c : kFacts) {
    const Outcome r = outcome_of(c.arguments);
    EXPECT_EQ(r.status, c.status) << c.arguments;
    EXPECT_TRUE(mentions(r.err, c.facts)) << c.arguments;
    EXPECT_EQ(file_count(), 0) << c.arguments;
  }
}

}  // namespace
}  // namespace orrery::test
