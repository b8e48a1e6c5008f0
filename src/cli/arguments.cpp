// SPDX-License-Identifier: Apache-2.0
#include "cli/arguments.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"

namespace orrery::cli {
namespace {

/// Adds no text to the help, where the option's description suffices.
CLI::Validator validator(Check check) { return CLI::Validator(std::move(check), ""); }

}  // namespace

Option* Option::required() {
  option_->required();
  return this;
}

Option* Option::type_name(const std::string& name) {
  option_->type_name(name);
  return this;
}

Option* Option::check(Check check) {
  option_->check(validator(std::move(check)));
  return this;
}

Option* Option::transform(Check check) {
  option_->transform(validator([this, check = std::move(check)](std::string& value) {
    typed_.push_back(value);
    return check(value);
  }));
  return this;
}

Option* Option::excludes(const Option* other) {
  option_->excludes(other->option_);
  return this;
}

Option* Option::may_be_empty() {
  option_->get_validator(0)->active(false);  // see Command::added()
  return this;
}

Option* Option::take_all() {
  option_->take_all();
  return this;
}

Option* Option::repeatable() {
  option_->take_all()->expected(1)->allow_extra_args(false);
  return this;
}

std::size_t Option::count() const { return option_->count(); }

std::vector<std::string> Option::arguments() const {
  if (option_->count() == 0) return {};
  const std::vector<std::string>& short_names = option_->get_snames();
  const std::string name = short_names.empty() ? "--" + option_->get_lnames().front() : "-" + short_names.front();
  const std::vector<std::string> values = typed_.empty() ? option_->results() : typed_;
  const bool is_flag = option_->get_items_expected_max() == 0;
  if (is_flag) return values.back() == "true" ? std::vector{name} : std::vector<std::string>{};
  std::vector<std::string> out;
  for (const std::string& value : values) {
    if (value.starts_with('-')) {
      out.push_back(fmt::format("{}={}", this->name(), value));
    } else {
      out.insert(out.end(), {name, value});
    }
  }
  return out;
}

std::string Option::name() const {
  const std::vector<std::string>& names = option_->get_lnames();
  return names.empty() ? "" : "--" + names.front();
}

void Option::require_one() const {
  const bool is_flag = option_->get_items_expected_max() == 0;  // a repeated flag means the same
  if (takes_several_ || is_flag || option_->count() < 2) return;
  std::vector<std::string> values;
  for (const std::string& value : typed_.empty() ? option_->results() : typed_)
    values.push_back(fmt::format("`{}`", value));
  base::refuse(
      fmt::format("{} is given {} times: {}; give it once", option_->get_name(), values.size(), base::joined(values)));
}

std::string Option::heading() const { return option_->get_group(); }

Command* Command::add_subcommand(const std::string& name, const std::string& description) {
  CLI::App* const command = app_->add_subcommand(name, description);
  if (!heading_.empty()) command->group(heading_);
  return &subcommands_.emplace_back(*command);
}

const Command& Command::subcommand(const std::string& name) const {
  return *std::find_if(subcommands_.begin(), subcommands_.end(),
                       [&](const Command& command) { return command.app_->get_name() == name; });
}

void Command::require_subcommand() { app_->require_subcommand(1); }

Option* Command::added(CLI::Option& option, bool takes_several) {
  // Otherwise, --frames "$frames" with an unset variable would be equivalent to no option.
  option.check(validator([](const std::string& value) { return value.empty() ? "the value is empty" : ""; }));
  return &options_.emplace_back(option, takes_several);
}

Option* Command::add_option(const std::string& names, std::string& variable, const std::string& description) {
  return added(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::filesystem::path& variable, const std::string& description) {
  return added(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, int& variable, const std::string& description) {
  return added(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::uint64_t& variable, const std::string& description) {
  return added(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, double& variable, const std::string& description) {
  return added(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::optional<double>& variable, const std::string& description) {
  return added(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::vector<std::string>& variable,
                            const std::string& description) {
  return added(*app_->add_option(names, variable, description), true);
}

Option* Command::add_option(const std::string& names, std::vector<std::filesystem::path>& variable,
                            const std::string& description) {
  return added(*app_->add_option(names, variable, description), true);
}

Option* Command::add_flag(const std::string& names, bool& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_flag(names, variable, description));
}

std::vector<std::string> Command::arguments(const std::string& heading) const {
  std::vector<std::string> out;
  for (const Option& option : options_) {
    if (option.heading() != heading) continue;
    const std::vector<std::string> words = option.arguments();
    out.insert(out.end(), words.begin(), words.end());
  }
  return out;
}

void Command::heading(const std::string& text) { heading_ = text; }

void Command::footer(const std::string& text) { app_->footer(text); }

void Command::callback(std::function<void()> function) {
  app_->callback([this, function = std::move(function)] {
    for (const Option& option : options_) option.require_one();
    function();
  });
}

OptionGroup::OptionGroup(Command& command, const std::string& heading)
    : app_(command.app_), outer_(app_->option_defaults()->get_group()) {
  app_->option_defaults()->group(heading);
}

OptionGroup::~OptionGroup() { app_->option_defaults()->group(outer_); }

}  // namespace orrery::cli
