// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

#include "plot/data_options.h"

namespace orrery::cli {

class Command;
class Option;

/// Arguments of the data options that need further parsing.
struct DataArguments {
  std::string frame, frames, radius, range, replicate, component;
  std::vector<std::string> select, slice;
  const Option* map = nullptr;
};

// The options that all commands on data files share. Values go to `data`, or to `arguments` and then to `data` by
// read_data_options().
//
// Domain     called once; `arguments` and `data` must not move until the command line is parsed

/// Adds FILE, the data file.
void add_data_file(Command& command, plot::DataOptions& data);

/// Adds the options for frames, selections and copies.
void add_data_options(Command& command, DataArguments& arguments, plot::DataOptions& data);

/// Adds the options for radius and colour, under the heading "Look options".
void add_look_options(Command& command, DataArguments& arguments, plot::DataOptions& data);

/// Sets the members of `data` from the parsed options.
///
/// Errors     base::Error(kUsage)
void read_data_options(const DataArguments& arguments, plot::DataOptions& data);

}  // namespace orrery::cli
