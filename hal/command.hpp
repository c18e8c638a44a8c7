// Commands of the program: what `tandem NAME …` takes, and what it does. The program's own and those of plug-ins alike.
//
//   struct Census {
//     std::string experiment;
//     bool quiet = false;
//     void describe(hal::CommandLine& line) {             the only place where its options are spelled
//       line.word("experiment", experiment, "The experiment file (.xml)").required().file();
//       line.flag("--quiet", quiet, "Only the sum");
//     }
//   };
//   hal::Result<int> count(const Census& census, const hal::CommandContext& context);       returns the exit code
//   const hal::CommandType command =
//       hal::command_type<Census, count>("census", "Count robots.", hal::command_group::kStudy);
//
// Help, completion and manual pages are made from what is described.
#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "hal/result.hpp"
#include "hal/surface.hpp"

namespace tandem::hal {

class Catalog;

/// An option, or a word that is told by its place. Options are written --name VALUE or --name=VALUE.
struct Argument {
  /// Where the value is put. Of a list: each value that is given. Alternatives are only ever appended.
  using Value = std::variant<bool*, std::string*, std::int64_t*, std::uint64_t*, double*, std::optional<std::string>*,
                             std::optional<std::int64_t>*, std::optional<std::uint64_t>*, std::optional<double>*,
                             std::vector<std::string>*, std::vector<std::int64_t>*, std::vector<double>*>;
  enum class Bound : std::uint8_t { None, Positive, NotNegative, Range };
  /// What a word stands for, where that is neither free text nor one of a list: shells complete it.
  enum class Meaning : std::uint8_t { Text, File, Folder };

  std::string names;  ///< "-o,--output", "--quiet"; of a word: "experiment"
  std::string text;   ///< for people, without the full stop
  Value value;
  Bound bound = Bound::None;
  Meaning meaning = Meaning::Text;
  bool is_required = false;
  bool shows_default = false;                 ///< in help
  bool is_repeatable = false;                 ///< a value each time it is written, not several after it
  bool is_list = false;                       ///< values are separated by commas
  bool is_hidden = false;                     ///< from help: for the program itself
  bool is_flag_or_number = false;             ///< "--view", or "--view=8080": a flag that may tell a number
  double least = 0.0, most = 0.0;             ///< of Bound::Range, both included
  int fewest = 0, most_many = 0;              ///< values; 0: as its type takes
  std::string placeholder;                    ///< in help, for the value; empty: its type
  std::string category;                       ///< of the catalog, whose names it takes
  std::vector<std::string> choices;           ///< no other value is taken
  std::vector<std::string> suggestions;       ///< values that shells offer besides
  std::vector<std::string> needed, excluded;  ///< options that must stand beside it, and that must not

  bool is_word() const { return !names.starts_with('-'); }
  bool is_flag() const { return std::holds_alternative<bool*>(value) || is_flag_or_number; }

  // For descriptions, one after the other: line.option(…).range(0, 5).needs("--film");
  Argument& required() { return set(is_required); }
  Argument& show_default() { return set(shows_default); }
  Argument& repeatable() { return set(is_repeatable); }
  Argument& separated() { return set(is_list); }
  Argument& hide() { return set(is_hidden); }
  Argument& positive() { return bounded(Bound::Positive, 0.0, 0.0); }
  Argument& not_negative() { return bounded(Bound::NotNegative, 0.0, 0.0); }
  Argument& range(double from, double to) { return bounded(Bound::Range, from, to); }
  Argument& count(int from, int to) {
    fewest = from;
    most_many = to;
    return *this;
  }
  Argument& file() { return means(Meaning::File); }
  Argument& folder() { return means(Meaning::Folder); }
  /// A name of the catalog's category, e.g. "engine".
  Argument& named_in(std::string_view of_catalog) {
    category = of_catalog;
    return *this;
  }
  Argument& one_of(std::vector<std::string> all) {
    choices = std::move(all);
    return *this;
  }
  Argument& suggest(std::vector<std::string> some) {
    suggestions = std::move(some);
    return *this;
  }
  Argument& written(std::string_view shown) {
    placeholder = shown;
    return *this;
  }
  Argument& needs(std::string_view option) {
    needed.emplace_back(option);
    return *this;
  }
  Argument& excludes(std::string_view option) {
    excluded.emplace_back(option);
    return *this;
  }

 private:
  Argument& set(bool& what) {
    what = true;
    return *this;
  }
  Argument& bounded(Bound how, double from, double to) {
    bound = how;
    least = from;
    most = to;
    return *this;
  }
  Argument& means(Meaning what) {
    meaning = what;
    return *this;
  }
};

/// Options of which at least and at most so many are given.
struct ArgumentChoice {
  std::string name, text;
  std::size_t least = 1, most = 1;
  std::vector<std::string> options;
};

/// Takes the description of one command's line. What is returned holds until the next call.
class CommandLine {
 public:
  using NamedValues = std::vector<std::pair<std::string, std::string>>;

  /// The next word that is no option.
  template <class T>
  Argument& word(std::string_view name, T& value, std::string_view text) {
    return add(name, &value, text);
  }
  /// `names`: "--output", or "-o,--output".
  template <class T>
  Argument& option(std::string_view names, T& value, std::string_view text) {
    static_assert(!std::is_same_v<T, bool>, "an option that is there or not is a flag");
    return add(names, &value, text);
  }
  Argument& flag(std::string_view names, bool& value, std::string_view text) { return add(names, &value, text); }
  /// --name, which gives 0, or --name=NUMBER, not negative.
  Argument& flag_or_number(std::string_view name, std::optional<std::int64_t>& value, std::string_view text) {
    Argument& made = add(name, &value, text);
    made.is_flag_or_number = true;
    return made;
  }
  /// Of these options, described before or after, so many are to be given.
  void choose(ArgumentChoice choice) { choices_.push_back(std::move(choice)); }
  /// Options that are not described are taken, too, as name and value.
  void further(NamedValues& values) { further_ = &values; }
  /// Below the options in help.
  void footer(std::string_view text) { footer_ = text; }
  /// An option that others have described is not there.
  void leave_out(std::string_view option) {
    std::erase_if(arguments_, [&](const Argument& a) { return a.names == option; });
    for (Argument& a : arguments_) {
      std::erase(a.needed, option);
      std::erase(a.excluded, option);
    }
  }

  const std::vector<Argument>& arguments() const noexcept { return arguments_; }
  const std::vector<ArgumentChoice>& choices() const noexcept { return choices_; }
  const std::string& footer() const noexcept { return footer_; }
  NamedValues* further() const noexcept { return further_; }

 private:
  Argument& add(std::string_view names, Argument::Value value, std::string_view text) {
    Argument& made = arguments_.emplace_back();
    made.names = names;
    made.text = text;
    made.value = value;
    return made;
  }

  std::vector<Argument> arguments_;
  std::vector<ArgumentChoice> choices_;
  std::string footer_;
  NamedValues* further_ = nullptr;
};

/// Handed to a command that runs.
class CommandContext {
 public:
  virtual ~CommandContext() = default;
  /// Everything that the program has, its commands too, and what the library of this command brought.
  virtual const Catalog& catalog() const = 0;
};

/// One call of a command: its values, which the line fills in between.
class CommandCall {
 public:
  virtual ~CommandCall() = default;
  /// The values that are described live as long as this.
  virtual void describe(CommandLine& line) = 0;
  /// @returns the exit code of the program: 0 done, 1 bad input, 2 wrong usage, 3 failed, 4 different. An error is a
  /// failure, and reported.
  virtual Result<int> run(const CommandContext& context) = 0;
};

/// Headings under which help lists commands, in this order; others come after them.
namespace command_group {
inline constexpr std::string_view kSimulate = "Simulate", kRealRobots = "Real robots", kStudy = "Study",
                                  kExtend = "Extend", kTools = "Tools", kFurther = "Further commands";
inline constexpr std::array kAll = {kSimulate, kRealRobots, kStudy, kExtend, kTools};
}  // namespace command_group

/// A command. "plugin new" is the command `new` of `plugin`, which is an entry without `make`.
struct CommandType {
  static constexpr std::string_view kCategory = "command";
  using Crosses =
      Layouts<Argument, Argument::Value, ArgumentChoice, CommandLine, CommandContext, CommandCall, Result<int>>;
  std::string_view name;
  std::string_view summary;  ///< one sentence
  std::unique_ptr<CommandCall> (*make)() = nullptr;
  std::string_view group = command_group::kFurther;  ///< heading in help

  std::string flaw() const {
    const auto fits = [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_' || c == '-'; };
    std::size_t length = 0, words = 1;
    for (const char c : name) {
      if (c == ' ' && length > 0 && words == 1) {
        length = 0;
        ++words;
      } else if (!fits(c) || (length == 0 && c == '-')) {
        return "is no command: its name has letters a to z, digits, _ and -";
      } else {
        ++length;
      }
    }
    return length > 0 ? "" : "has no name";
  }
};

/// The table of a command with values of class `T`, which describes them: `kRun(values)` or `kRun(values, context)`
/// returns what `CommandCall::run` does.
template <class T, auto kRun>
constexpr CommandType command_type(std::string_view name, std::string_view summary,
                                   std::string_view group = command_group::kFurther) {
  class Called final : public CommandCall {
   public:
    void describe(CommandLine& line) override { values_.describe(line); }
    Result<int> run(const CommandContext& context) override {
      if constexpr (std::is_invocable_v<decltype(kRun), const T&, const CommandContext&>)
        return kRun(values_, context);
      else
        return kRun(values_);
    }

   private:
    T values_;
  };
  return {name, summary, []() -> std::unique_ptr<CommandCall> { return std::make_unique<Called>(); }, group};
}

}  // namespace tandem::hal
