// SPDX-License-Identifier: Apache-2.0
// Exact text of error messages: people and scripts read them.
#include "cli/program.h"

namespace orrery::test {
namespace {

struct MessageCase {
  const char* arguments;
  int status;
  const char* message;  ///< all of stderr
};

const MessageCase kCases[] = {
    {"", 2,
     "orrery: no command given; use one of render, plot, view, merge, submit, check, info, compare, bench, study, "
     "generate, "
     "convert, develop, denoise\n"
     "Try orrery --help.\n"},
    {"rendr good.toml", 2,
     "orrery: unknown command rendr; did you mean `render`?\n"
     "Try orrery --help.\n"},
    {"good.toml", 2,
     "orrery: unknown command good.toml; to render it: orrery render good.toml -o image.png\n"
     "Try orrery --help.\n"},
    {"render good.toml -o a.png --samlpes 3", 2,
     "orrery: unknown option --samlpes; did you mean `--samples`?\n"
     "Try orrery render --help.\n"},
    {"render good.toml", 2,
     "orrery: --output is required\n"
     "Try orrery render --help.\n"},
    {"render -o a.png", 2,
     "orrery: SCENE is required\n"
     "Try orrery render --help.\n"},
    {"render good.toml -o a.png b.png", 2, "orrery: unexpected argument `b.png`; name output files with -o\n"},
    {"render good.toml -o a.png -t many", 2,
     "orrery: --threads: must be an integer from 1 to 4096, not `many`\n"
     "Try orrery render --help.\n"},
    {"develop a.exr -o a.png --exposure bright", 2,
     "orrery: --exposure: must be a number from -100 to 100, not `bright`\n"
     "Try orrery develop --help.\n"},
    {"develop a.exr -o a.png --exposure", 2,
     "orrery: --exposure needs a value\n"
     "Try orrery develop --help.\n"},
    {"render good.toml -o a.png --progress jsno", 2,
     "orrery: --progress: unknown value `jsno`; did you mean `json`?\n"
     "Try orrery render --help.\n"},
    {"render good.toml -o a.png --quiet=maybe", 2,
     "orrery: --quiet takes no value\n"
     "Try orrery render --help.\n"},
    {"render good.toml -o a.exr --compression zipp", 2,
     "orrery: unknown EXR compression zipp; did you mean `zip`? known names are none, rle, zip, zips, piz, dwaa, dwab; "
     "dwaa and dwab take a level, e.g. dwaa:45\n"},
    {"render good.toml -o a.jpg --bits 16", 2, "orrery: a.jpg holds 8 bits per channel; use PNG or TIFF for 16\n"},
    {"render good.toml -o a.png -o ./a.png", 2,
     "orrery: ./a.png (-o) and a.png (-o) are the same file; choose another name\n"},
    {"render good.toml -o a.png --stats good.toml", 2,
     "orrery: good.toml (--stats) would overwrite good.toml (scene); choose another name\n"},
    {"render none.toml -o a.png", 66, "orrery: cannot open none.toml: No such file or directory\n"},
    {"render good.toml -o none/a.png", 73, "orrery: cannot create none/a.png: directory none does not exist\n"},
    {"info good.toml --json --settings", 2,
     "orrery: --json excludes --settings\n"
     "Try orrery info --help.\n"},
    {"render good.toml -o a.png --samples 1 --samples 2", 2,
     "orrery: --samples is given 2 times: `1`, `2`; give it once\n"},
    {"plot a.xyz -o a.png --up x --up y", 2, "orrery: --up is given 2 times: `x`, `y`; give it once\n"},
    {"convert a.xyz -o a.ply -o b.ply", 2, "orrery: --output is given 2 times: `a.ply`, `b.ply`; give it once\n"},
    {"generate cloud -o a.toml --seed 1 --seed 1", 2, "orrery: --seed is given 2 times: `1`, `1`; give it once\n"},
    {"submit good.toml --slurm -o a.exr --noise 0.1 --noise 0.2", 2,
     "orrery: --noise is given 2 times: `0.1`, `0.2`; give it once\n"},
    {"info good.toml > /dev/full", 74, "orrery: writing to standard output failed: No space left on device\n"},
    {"--version > /dev/full", 74, "orrery: writing to standard output failed: No space left on device\n"},
    {"check good.toml > /dev/full", 74, "orrery: writing to standard output failed: No space left on device\n"},
    {"generate", 2,
     "orrery: no command given; use one of final, cloud\n"
     "Try orrery generate --help.\n"},
    {"generate fianl -o a.toml", 2,
     "orrery: unknown command fianl; did you mean `final`?\n"
     "Try orrery generate --help.\n"},
    {"generate final -o a.toml --grid -3", 2,
     "orrery: --grid: must be an integer from 0 to 1000, not `-3`\n"
     "Try orrery generate final --help.\n"},
    {"develop a.png -o b.png", 2, "orrery: a.png is already display-encoded; the input must be exr or hdr\n"},
    {"develop none.exr -o b.png", 66, "orrery: cannot open none.exr: No such file or directory\n"},
    {"compare none.exr none.exr", 66, "orrery: cannot open none.exr: No such file or directory\n"},
    {"compare a.png b.exr", 2,
     "orrery: b.exr is scene-linear, but the other image is display-encoded; develop it first: orrery develop b.exr "
     "-o developed.png\n"},
    {"compare a.exr b.exr --fail-above rsme=1", 2,
     "orrery: --fail-above rsme=1: unknown metric; did you mean `rmse`?\n"},
    {"compare a.exr b.exr --fail-above rmse", 2, "orrery: --fail-above rmse: write METRIC=VALUE, e.g. rmse=0.001\n"},
    {"compare a.exr b.exr --fail-above rmse=-1", 2,
     "orrery: --fail-above rmse=-1: the value must be a number, 0 or more\n"},
    {"compare a.exr b.exr --fail-above psnr=40", 2,
     "orrery: --fail-above psnr=40: psnr decreases with the error; limit rmse or flip instead\n"},
};

class CliMessages : public ProgramTest, public testing::WithParamInterface<MessageCase> {};

TEST_P(CliMessages, MatchTheGoldenText) {
  const MessageCase& c = GetParam();
  // A case's own redirection comes last on the command line, so it overrides the test's.
  const std::string arguments = c.arguments;
  const std::size_t to = arguments.find(" > ");
  const Outcome r =
      to == std::string::npos ? run(arguments) : run(arguments.substr(0, to) + " 2>.err" + arguments.substr(to) + " #");
  EXPECT_EQ(r.status, c.status);
  EXPECT_EQ(r.err, c.message);
  EXPECT_EQ(file_count(), 0);
}

std::string name_of(const testing::TestParamInfo<MessageCase>& info) { return std::to_string(info.index); }

INSTANTIATE_TEST_SUITE_P(Table, CliMessages, testing::ValuesIn(kCases), name_of);

}  // namespace
}  // namespace orrery::test
