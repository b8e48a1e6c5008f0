// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace orrery::load {

/// Remedy of an override that cannot be understood.
inline constexpr const char* kOverrideExample = "write KEY=VALUE, e.g. camera.vfov=30 or sphere[0].radius=2";

/// A key that an override sets, and its value.
struct KeyValue {
  /// monostate: a list, a date or a time.
  using Value = std::variant<std::monostate, bool, std::int64_t, double, std::string>;

  std::string key;   ///< as in messages, without quotes: "camera.vfov", "material.dark gold.fuzz", "sphere[2].radius"
  std::string text;  ///< an override that sets the same: `material."dark gold".fuzz=0.5`
  Value value;
};

/// A setting of the command line: `--set KEY=VALUE`, or a short form such as `--samples 20`.
struct Override {
  /// An error of an override by itself.
  struct Fault {
    std::string text, remedy;
  };
  /// True if the override sets this key, or a table or list that contains it.
  bool sets(std::string_view key) const;

  std::string option;            ///< as the user typed it: "--set", "--samples"
  std::string typed;             ///< the option's value, as the user typed it
  std::vector<KeyValue> values;  ///< tables are flattened; empty if there is a fault
  std::optional<Fault> fault;
  std::string element;    ///< the list element that contains the key: "sphere[2]"; empty: none
  std::string toml;       ///< the override as TOML: the key within `element`, and the value, whose words are quoted
  bool replaces = false;  ///< tables replace those of the scene instead of being merged into them
};

/// The overrides of a scene, in the order in which they apply: the last one of a key wins.
///
/// All spellings of an override are equal: `render={samples=20}`, `render.samples = 20` and `"render".samples=20` set
/// the same key. An invalid override sets nothing; its error is reported with those of the scene.
class Overrides {
 public:
  Overrides() = default;
  Overrides(std::initializer_list<std::string> settings) {
    for (const std::string& setting : settings) add(setting);
  }

  /// Adds `--set KEY=VALUE`. Keys are dotted, list elements are counted from 0: "camera.vfov=30",
  /// "material.\"my gold\".fuzz=0.3", "sphere[2].radius=0.5", "output.layers=[Z,N]".
  ///
  /// A value is TOML; words and lists of words need no quotes.
  void add(const std::string& key_and_value, bool replaces = false);

  /// Adds a short form of a key: add_option("--samples", "render.samples", "20").
  ///
  /// `is_list`  `typed` consists of the words of a list, separated by commas
  void add_option(const std::string& option, const std::string& key, const std::string& typed, bool is_list = false);

  /// Adds an override of other overrides.
  void add(const Override& other) { list_.push_back(other); }

  bool sets(std::string_view key) const;

  /// The value of a key if it is an integer, a number or a string; otherwise, and if it is not set, nullopt.
  std::optional<std::int64_t> integer(std::string_view key) const;
  std::optional<double> number(std::string_view key) const;
  std::optional<std::string> string(std::string_view key) const;

  /// All keys with the values that count, each once.
  std::vector<KeyValue> values() const;

  bool empty() const { return list_.empty(); }
  std::size_t size() const { return list_.size(); }
  const Override& operator[](std::size_t i) const { return list_[i]; }
  std::vector<Override>::const_iterator begin() const { return list_.begin(); }
  std::vector<Override>::const_iterator end() const { return list_.end(); }

 private:
  template <class T>
  std::optional<T> value(std::string_view key) const;

  std::vector<Override> list_;
};

}  // namespace orrery::load
