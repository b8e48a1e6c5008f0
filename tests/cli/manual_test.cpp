// SPDX-License-Identifier: Apache-2.0
// The manual page lists exactly the options of the commands.
#include <map>
#include <set>
#include <sstream>
#include <vector>

#include "cli/program.h"

namespace orrery::test {
namespace {

using Options = std::set<std::string>;

std::vector<std::string> words_of(const std::string& line) {
  std::istringstream in(line);
  std::vector<std::string> words;
  for (std::string word; in >> word;) words.push_back(word);
  return words;
}

/// Adds the long options of an mdoc line ("Fl Fl NAME").
void add_options(const std::string& line, Options& options) {
  const std::vector<std::string> words = words_of(line);
  for (std::size_t i = 0; i + 2 < words.size(); ++i)
    if (words[i] == "Fl" && words[i + 1] == "Fl") options.insert("--" + words[i + 2]);
}

/// Options listed in the manual page.
struct Manual {
  std::map<std::string, Options> synopsis;               ///< by command
  std::map<std::string, Options> sections;               ///< by the title of a .Ss
  std::map<std::string, std::set<std::string>> members;  ///< commands of each section "... options"

  /// Options in the command's section and in the shared sections that list the command.
  Options options_of(const std::string& command) const {
    Options out = sections.at("orrery " + command);
    for (const auto& [section, commands] : members)
      if (commands.count(command) > 0) out.insert(sections.at(section).begin(), sections.at(section).end());
    return out;
  }
};

Manual read_manual() {
  Manual manual;
  std::istringstream in(text_of(ORRERY_MANUAL));
  std::string section, command;
  bool is_list = false;
  for (std::string line; std::getline(in, line);) {
    const std::vector<std::string> words = words_of(line);
    if (words.empty()) continue;
    if (words[0] == ".Ss" || words[0] == ".Sh") {
      section = line.substr(4);
      is_list = false;
      if (words[0] == ".Ss") manual.sections[section];
    } else if (section == "SYNOPSIS" && words[0] == ".Nm") {
      command.clear();
      for (std::size_t i = 3; i < words.size(); ++i) command += (i > 3 ? " " : "") + words[i];
    } else if (section == "SYNOPSIS") {
      std::string spaced = line;
      if (!command.empty() && words[0] == ".Fl") spaced = ". Fl" + line.substr(3);
      if (!command.empty()) add_options(spaced, manual.synopsis[command]);
    } else if (words[0] == ".Bl") {
      is_list = true;
    } else if (words[0] == ".It") {
      if (manual.sections.count(section) > 0) add_options(line, manual.sections[section]);
    } else if (words[0] == ".Cm" && !is_list && section.ends_with(" options")) {
      for (std::size_t i = 1; i < words.size(); ++i) manual.members[section].insert(words[i]);
    }
  }
  return manual;
}

class CliManual : public ProgramTest {
 protected:
  /// Long options at the start of the lines of --help.
  Options help_of(const std::string& command) {
    Options options;
    std::istringstream in(run(command + " --help").out);
    for (std::string line; std::getline(in, line);) {
      const std::vector<std::string> words = words_of(line);
      if (words.empty() || line[0] != ' ' || words[0][0] != '-') continue;
      std::istringstream names(words[0]);
      for (std::string name; std::getline(names, name, ',');)
        if (name.starts_with("--") && name != "--help") options.insert(name);
    }
    EXPECT_FALSE(options.empty()) << command;
    return options;
  }
};

TEST_F(CliManual, ListsTheOptionsOfEveryCommand) {
  const Manual manual = read_manual();
  EXPECT_EQ(manual.synopsis.size(), 17u);
  Options generate;
  for (const auto& [command, in_synopsis] : manual.synopsis) {
    const Options known = help_of(command);
    for (const std::string& option : in_synopsis)
      EXPECT_EQ(known.count(option), 1u) << "synopsis of " << command << ": " << option;
    if (command.starts_with("generate ")) {
      generate.insert(known.begin(), known.end());
    } else {
      EXPECT_EQ(manual.options_of(command), known) << command;
    }
  }
  EXPECT_EQ(manual.options_of("generate"), generate);
}

}  // namespace
}  // namespace orrery::test
