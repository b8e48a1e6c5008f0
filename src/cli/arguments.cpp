// SPDX-License-Identifier: Apache-2.0
#include "cli/arguments.h"

#include <CLI/CLI.hpp>

#include <utility>

namespace orrery::cli {
namespace {

/// Has no text of its own in the help: the option's description is better.
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
  option_->transform(validator(std::move(check)));
  return this;
}

Option* Option::excludes(const Option* other) {
  option_->excludes(other->option_);
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

Command* Command::add_subcommand(const std::string& name, const std::string& description) {
  return &subcommands_.emplace_back(*app_->add_subcommand(name, description));
}

void Command::require_subcommand() { app_->require_subcommand(1); }

Option* Command::add_option(const std::string& names, std::string& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::filesystem::path& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, int& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::uint64_t& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, double& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::optional<double>& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::vector<std::string>& variable,
                            const std::string& description) {
  return &options_.emplace_back(*app_->add_option(names, variable, description));
}

Option* Command::add_option(const std::string& names, std::vector<std::filesystem::path>& variable,
                            const std::string& description) {
  return &options_.emplace_back(*app_->add_option(names, variable, description));
}

Option* Command::add_flag(const std::string& names, bool& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_flag(names, variable, description));
}

void Command::footer(const std::string& text) { app_->footer(text); }

void Command::callback(std::function<void()> function) { app_->callback(std::move(function)); }

}  // namespace orrery::cli
