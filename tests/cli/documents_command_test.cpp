// SPDX-License-Identifier: Apache-2.0
// The manual page and the completions, which are written from the options of the commands.
#include <set>
#include <sstream>
#include <vector>

#include "cli/program.h"

namespace orrery::test {
namespace {

class CliDocuments : public ProgramTest {
 protected:
  static std::string document(const std::string& name) { return text_of(std::string(ORRERY_DOCUMENTS "/") + name); }

  /// Long options at the start of the lines of --help.
  std::set<std::string> options_of(const std::string& command) {
    std::set<std::string> options;
    std::istringstream in(run(command + " --help").out);
    for (std::string line; std::getline(in, line);) {
      const std::size_t name = line.find("--");
      if (line[0] == ' ' && name != std::string::npos && name <= 5)
        options.insert(line.substr(name + 2, line.find_first_of(", ", name) - name - 2));
    }
    EXPECT_GT(options.size(), 1u) << command;
    return options;
  }

  /// What bash offers for the last word of a command line.
  std::string completed(const std::string& words) {
    const std::string script = "source '" ORRERY_DOCUMENTS "/orrery.bash'; COMP_WORDS=(orrery " + words +
                               "); COMP_CWORD=$((${#COMP_WORDS[@]} - 1)); _orrery; echo \"${COMPREPLY[@]}\"";
    write("complete.sh", script);
    EXPECT_EQ(std::system(
                  ("bash '" + (folder_ / "complete.sh").string() + "' > '" + (folder_ / "out").string() + "'").c_str()),
              0);
    return text_of(folder_ / "out");
  }
};

TEST_F(CliDocuments, HaveTheOptionsOfEveryCommand) {
  const std::string manual = document("orrery.1"), zsh = document("_orrery"), fish = document("orrery.fish");
  for (const std::string command : {"render", "plot", "merge", "submit", "check", "info", "compare", "bench", "study",
                                    "generate final", "generate cloud", "convert", "develop", "denoise"}) {
    EXPECT_TRUE(contains(manual, ".Nm orrery Cm " + command + "\n")) << command;
    const std::size_t begin = manual.find(".Ss orrery " + command + "\n");
    ASSERT_NE(begin, std::string::npos) << command;
    const std::string section = manual.substr(begin, manual.find("\n.S", begin) - begin);
    for (const std::string& option : options_of(command)) {
      if (option == "help") continue;
      EXPECT_TRUE(contains(section, "Fl Fl " + option)) << command << " --" << option;
      EXPECT_TRUE(contains(zsh, "--" + option)) << command << " --" << option;
      const std::string last = command.substr(command.find(' ') + 1);
      EXPECT_TRUE(contains(fish, "'__fish_seen_subcommand_from " + last + "'")) << command;
      EXPECT_TRUE(contains(fish, " -l " + option)) << command << " --" << option;
    }
  }
}

TEST_F(CliDocuments, ManualHasTheCheckedPartsOfItsTemplate) {
  const std::string manual = document("orrery.1");
  EXPECT_EQ(manual.find('@'), std::string::npos);
  EXPECT_TRUE(contains(manual, ".Sh EXIT STATUS\n"));
  EXPECT_FALSE(contains(manual, "documents"));
}

TEST_F(CliDocuments, BashCompletesCommandsOptionsAndValues) {
  EXPECT_EQ(completed("gen"), "generate\n");
  EXPECT_EQ(completed("generate ''"), "final cloud\n");
  EXPECT_EQ(completed("render a.toml --sampl"), "--samples --sample-range\n");
  EXPECT_EQ(completed("plot a.xyz --progress ''"), "auto bar alf openjd arnold json none\n");
  EXPECT_EQ(completed("generate final --gr"), "--grid\n");
  EXPECT_EQ(completed("render sc"), "\n") << "a file";
}

}  // namespace
}  // namespace orrery::test
