// SPDX-License-Identifier: Apache-2.0
#include "cli/arguments.h"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <type_traits>
#include <utility>

#include <fmt/core.h>

#include "base/error.h"
#include "base/text.h"
#include "cli/signals.h"

namespace orrery::cli {
namespace {

/// Maximum time limit, one year in seconds: a longer time probably has the wrong unit.
constexpr double kLongestTime = 365.0 * 24 * 3600;
/// Minimum time limit, seconds; 0 would mean no limit.
constexpr double kShortestTime = 0.01;

/// Parses times such as "1h30m": numbers with units, in descending order.
///
/// Result     seconds; empty for any other text
std::optional<double> seconds_of(std::string_view text) {
  if (text.empty() || text.find_first_not_of("0123456789.hms") != std::string_view::npos) return {};
  double seconds = 0;
  for (const auto& [unit, factor] : {std::pair{'h', 3600.0}, std::pair{'m', 60.0}, std::pair{'s', 1.0}}) {
    const std::size_t end = text.find(unit);
    if (end == std::string_view::npos) continue;
    const auto number = base::number_of<double>(text.substr(0, end));
    if (!number) return {};
    seconds += *number * factor;
    text.remove_prefix(end + 1);
  }
  return text.empty() ? std::optional(seconds) : std::nullopt;
}

/// Adds no text to the help, where the option's description suffices.
CLI::Validator validator(Check check) { return CLI::Validator(std::move(check), ""); }

}  // namespace

Check one_of(std::vector<std::string> names) {
  return [names = std::move(names)](std::string& word) -> std::string {
    if (base::contains(names, word)) return {};
    const bool is_number = !word.empty() && word[0] >= '0' && word[0] <= '9';  // do not suggest 16 for 12
    const std::string remedy = is_number ? "" : base::did_you_mean(word, names);
    return fmt::format("unknown value `{}`; {}", word, remedy.empty() ? "use one of " + base::joined(names) : remedy);
  };
}

Check whole_number(std::uint64_t from, std::uint64_t to) {
  return [from, to](std::string& text) -> std::string {
    const auto value = base::number_of<std::uint64_t>(text);
    if (value && *value >= from && *value <= to) {
      text = std::to_string(*value);  // CLI11 would read 010 as eight
      return {};
    }
    return fmt::format("must be an integer from {} to {}, not `{}`", from, to, text);
  };
}

Check real_number(double from, double to) {
  return [from, to](std::string& text) -> std::string {
    const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
    const auto value = base::number_of<double>(plus ? text.substr(1) : text);
    if (value && *value >= from && *value <= to) return {};
    return fmt::format("must be a number from {:g} to {:g}, not `{}`", from, to, text);
  };
}

Check byte_size() {
  return [](std::string& text) -> std::string {
    constexpr std::string_view kUnits = "KMGT";
    const std::size_t unit = text.empty() ? std::string::npos : kUnits.find(text.back());
    const auto number = base::number_of<double>(text.substr(0, text.empty() ? 0 : text.size() - 1));
    if (unit != std::string::npos && number) {
      const double value = std::ldexp(*number, 10 * (static_cast<int>(unit) + 1));
      if (value >= 1 && value < 0x1p63) {
        text = std::to_string(static_cast<std::uint64_t>(value));
        return {};
      }
    }
    return fmt::format("must be a size with a unit, e.g. 512M or 1.5G, not `{}`", text);
  };
}

Check duration() {
  return [](std::string& text) -> std::string {
    const std::optional<double> seconds = seconds_of(text);
    if (!seconds) return fmt::format("must be a time such as 90s, 5m, 1.5h or 1h30m, not `{}`", text);
    if (!(*seconds >= kShortestTime && *seconds <= kLongestTime))
      return fmt::format("must be from {:g}s to {:g}h, not `{}`", kShortestTime, kLongestTime / 3600, text);
    text = fmt::format("{:.17g}", *seconds);
    return {};
  };
}

std::string full_name(const CLI::App& command) {
  const CLI::App* const outer = command.get_parent();
  return (outer != nullptr ? full_name(*outer) + " " : "") + command.get_name();
}

Option* Option::required() {
  option_->required();
  return this;
}

Option* Option::choices(std::vector<std::string> words) {
  choices_ = words;
  return check(one_of(std::move(words)));
}

Option* Option::details(const char* sentences) {
  details_ = sentences;
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

Option* Option::may_be_empty() {
  option_->get_validator(0)->active(false);  // see Command::added()
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

OptionText Option::text() const {
  OptionText out;
  for (const std::string& name : option_->get_snames()) out.names.push_back("-" + name);
  for (const std::string& name : option_->get_lnames()) out.names.push_back("--" + name);
  if (out.names.empty()) out.names.push_back(option_->get_name());
  if (option_->get_items_expected_max() > 0) out.type = option_->get_type_name();
  out.description = option_->get_description();
  out.details = details_;
  out.heading = option_->get_group();
  out.choices = choices_;
  out.is_required = option_->get_required();
  out.is_repeatable = takes_several_;
  return out;
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

void Command::require_subcommand() { app_->require_subcommand(1); }

void Command::hide() { app_->group(""); }

std::string Command::name() const { return app_->get_name(); }

std::string Command::description() const { return app_->get_description(); }

bool Command::is_hidden() const { return app_->get_group().empty(); }

Option* Command::added(CLI::Option& option, const std::string& type, bool takes_several) {
  option.type_name(type);
  // Otherwise, --frames "$frames" with an unset variable would be equivalent to no option.
  option.check(validator([](const std::string& value) { return value.empty() ? "the value is empty" : ""; }));
  return &options_.emplace_back(option, takes_several);
}

template <class Variable>
Option* Command::add_option(const std::string& names, Variable& variable, const std::string& type,
                            const std::string& description) {
  constexpr bool kIsList = std::is_same_v<Variable, std::vector<std::string>> ||
                           std::is_same_v<Variable, std::vector<std::filesystem::path>>;
  return added(*app_->add_option(names, variable, description), type, kIsList);
}

using Text = std::string;
template Option* Command::add_option(const Text&, Text&, const Text&, const Text&);
template Option* Command::add_option(const Text&, std::filesystem::path&, const Text&, const Text&);
template Option* Command::add_option(const Text&, int&, const Text&, const Text&);
template Option* Command::add_option(const Text&, std::uint64_t&, const Text&, const Text&);
template Option* Command::add_option(const Text&, double&, const Text&, const Text&);
template Option* Command::add_option(const Text&, std::optional<int>&, const Text&, const Text&);
template Option* Command::add_option(const Text&, std::optional<double>&, const Text&, const Text&);
template Option* Command::add_option(const Text&, std::vector<Text>&, const Text&, const Text&);
template Option* Command::add_option(const Text&, std::vector<std::filesystem::path>&, const Text&, const Text&);

Option* Command::add_flag(const std::string& names, bool& variable, const std::string& description) {
  return &options_.emplace_back(*app_->add_flag(names, variable, description));
}

std::vector<std::string> Command::arguments(const std::function<bool(const Option&)>& is_wanted) const {
  std::vector<std::string> out;
  for (const Option& option : options_) {
    if (!is_wanted(option)) continue;
    const std::vector<std::string> words = option.arguments();
    out.insert(out.end(), words.begin(), words.end());
  }
  return out;
}

void Command::heading(const std::string& text) { heading_ = text; }

void Command::footer(const std::string& text) {
  footer_ = text;
  app_->footer(text);
}

void Command::action(std::function<int()> run) { action_ = std::move(run); }

void Command::act(std::function<void()> run) {
  action([run = std::move(run)] {
    end_on_signals();
    run();
    return 0;
  });
}

int Command::run() const {
  const auto named =
      std::find_if(subcommands_.begin(), subcommands_.end(), [](const Command& c) { return c.app_->parsed(); });
  if (named != subcommands_.end()) return named->run();
  for (const Option& option : options_) option.require_one();
  return action_();
}

OptionGroup::OptionGroup(Command& command, const std::string& heading)
    : app_(command.app_), outer_(app_->option_defaults()->get_group()) {
  app_->option_defaults()->group(heading);
}

OptionGroup::~OptionGroup() { app_->option_defaults()->group(outer_); }

}  // namespace orrery::cli
