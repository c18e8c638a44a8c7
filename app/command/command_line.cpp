// Reads command lines by what commands describe: the only source that knows CLI11.
#include "app/command/command_line.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <deque>
#include <exception>
#include <iterator>
#include <memory>
#include <new>
#include <sstream>

#include "app/build_info.hpp"
#include "app/command/known_commands.hpp"
#include "app/command/launcher_commands.hpp"
#include "app/process/terminal.hpp"
#include "app/run_options.hpp"
#include "hal/element.hpp"
#include "hal/plugin_call.hpp"

namespace tandem::app {
namespace {

using hal::Argument;

bool is_whole_number(const Argument::Value& value) {
  return std::visit(
      [](auto* v) {
        using T = std::remove_pointer_t<decltype(v)>;
        return std::is_same_v<T, std::int64_t> || std::is_same_v<T, std::uint64_t> ||
               std::is_same_v<T, std::optional<std::int64_t>> || std::is_same_v<T, std::optional<std::uint64_t>> ||
               std::is_same_v<T, std::vector<std::int64_t>>;
      },
      value);
}

CLI::Option* add_value(CLI::App& app, const Argument& a) {
  return std::visit(
      [&](auto* value) -> CLI::Option* {
        using T = std::remove_pointer_t<decltype(value)>;
        if constexpr (std::is_same_v<T, bool>) {
          return app.add_flag(a.names, *value, a.text);
        } else {
          if constexpr (std::is_same_v<T, std::optional<std::int64_t>>) {
            const auto take = [value](std::int64_t n) {
              *value = std::max<std::int64_t>(0, n);
            };  // CLI11 makes -1 of 0
            if (a.is_flag_or_number) return app.add_flag_function(a.names + "{0}", take, a.text);
          }
          return app.add_option(a.names, *value, a.text);
        }
      },
      a.value);
}

void bound(CLI::Option& option, const Argument& a) {
  if (a.bound == Argument::Bound::Positive) option.check(CLI::PositiveNumber);
  if (a.bound == Argument::Bound::NotNegative) option.check(CLI::NonNegativeNumber);
  if (a.bound != Argument::Bound::Range) return;
  if (is_whole_number(a.value))
    option.check(CLI::Range(static_cast<std::int64_t>(a.least), static_cast<std::int64_t>(a.most)));
  else
    option.check(CLI::Range(a.least, a.most));
}

void add_argument(CLI::App& app, const Argument& a) {
  CLI::Option& option = *add_value(app, a);
  option.required(a.is_required);
  if (a.shows_default) option.capture_default_str();
  bound(option, a);
  if (!a.choices.empty()) option.check(CLI::IsMember(a.choices));
  if (a.is_list) option.delimiter(',');
  if (a.most_many > 0 && a.fewest == a.most_many) option.expected(a.most_many);
  if (a.most_many > a.fewest) option.expected(a.fewest, a.most_many);
  if (a.is_repeatable) option.allow_extra_args(false);
  if (a.is_hidden) option.group("");
  if (!a.placeholder.empty()) option.type_name(a.placeholder);
}

void add_line(CLI::App& app, const hal::CommandLine& line) {
  if (!line.footer().empty()) app.footer(line.footer());
  std::map<std::string, CLI::App*> group_of;
  for (const hal::ArgumentChoice& choice : line.choices()) {
    auto* const group = app.add_option_group(choice.name, choice.text);
    group->require_option(choice.least, choice.most);
    for (const std::string& names : choice.options) group_of[names] = group;
  }
  for (const Argument& a : line.arguments()) {
    const auto group = group_of.find(a.names);
    add_argument(group != group_of.end() ? *group->second : app, a);
  }
  const auto option_of = [&](const std::string& names) { return app.get_option(names.substr(names.rfind(',') + 1)); };
  for (const Argument& a : line.arguments()) {
    for (const std::string& other : a.needed) option_of(a.names)->needs(app.get_option(other));
    for (const std::string& other : a.excluded) option_of(a.names)->excludes(app.get_option(other));
  }
  if (line.further() != nullptr) app.allow_extras();
}

/// "--name value" and "--name=value", as further options are written.
hal::CommandLine::NamedValues further_options(const std::string& command, const std::vector<std::string>& words) {
  hal::CommandLine::NamedValues further;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (word.size() < 3 || !word.starts_with("--")) throw CLI::ExtrasError(command, {word});
    const std::size_t equals = word.find('=');
    if (equals != std::string::npos) {
      further.emplace_back(word.substr(2, equals - 2), word.substr(equals + 1));
    } else {
      if (i + 1 == words.size()) throw CLI::ArgumentMismatch(word + " needs a value");
      further.emplace_back(word.substr(2), words[++i]);
    }
    const std::string& name = further.back().first;
    if (std::ranges::count(further, name, &std::pair<std::string, std::string>::first) > 1)
      throw CLI::ArgumentMismatch("--" + name + " stands twice; several values go into one, separated by spaces");
  }
  return further;
}

/// A command that the line may name.
struct Candidate {
  const hal::CommandType* type = nullptr;
  std::string origin;
  CLI::App* app = nullptr;
  std::unique_ptr<hal::CommandCall> command = {};
  hal::CommandLine line = {};

  bool is_plugins() const { return origin != hal::Catalog::kInside; }
  /// For messages about those of plug-ins.
  std::string name() const { return "command '" + std::string(type->name) + "' (library '" + origin + "')"; }
};

void name_call(const void* candidate, std::size_t /*part*/, std::size_t /*index*/, hal::FixedText& out) noexcept {
  const auto& c = *static_cast<const Candidate*>(candidate);
  out << "command '" << c.type->name << "' (library '" << c.origin << "')";
}

/// Calls what is a plug-in's by its name, also where it throws.
template <class Call>
auto calling(const Candidate& candidate, Call&& call) {
  if (!candidate.is_plugins()) return call();
  const hal::PluginCall marked(&name_call, &candidate);
  try {
    return call();
  } catch (const std::exception& e) {
    throw std::runtime_error(candidate.name() + ": " + e.what());
  } catch (...) {
    throw std::runtime_error(candidate.name() + " threw what is no std::exception");
  }
}

/// The program's line, as far as it is needed for this call.
class Line {
 public:
  explicit Line(const Program& program) : app_(std::string(program.title), "tandem") {
    app_.footer(std::string(program.footer));
    app_.require_subcommand(1);
    app_.set_version_flag("--version", [] { return version_text(); });
    app_.failure_message(CLI::FailureMessage::help);
    app_.add_option("--plugin", plugins_, "Before the command: library that brings it, or what it may name; repeatable")
        ->allow_extra_args(false);
  }

  void add(const hal::CommandType& type, const std::string& origin) {
    Candidate& candidate = candidates_.emplace_back(Candidate{&type, origin});
    const std::string name(type.name);
    const std::size_t space = name.find(' ');
    CLI::App* const parent = space == std::string::npos ? &app_ : app_.get_subcommand(name.substr(0, space));
    candidate.app = parent->add_subcommand(name.substr(space == std::string::npos ? 0 : space + 1),
                                           printable(std::string(type.summary)));
    if (parent == &app_) candidate.app->group(printable(std::string(type.group)));
    if (type.make == nullptr) {  // a group, or of a module that is not loaded
      candidate.app->require_subcommand(1);
      return;
    }
    calling(candidate, [&] {
      candidate.command = type.make();
      candidate.command->describe(candidate.line);
      add_line(*candidate.app, candidate.line);
    });
  }

  /// @returns the command that is named, with its values.
  Candidate& parse(std::vector<std::string> words) {
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app_.parse(std::move(words));
    const CLI::App* named = &app_;
    while (!named->get_subcommands().empty()) named = named->get_subcommands().front();
    Candidate& found = *std::ranges::find(candidates_, named, &Candidate::app);
    if (found.line.further() != nullptr) *found.line.further() = further_options(named->get_name(), named->remaining());
    return found;
  }

  /// What is wrong with the words, and where they are told.
  std::string complaint(const CLI::ParseError& e) const {
    std::string command = app_.get_name();
    const CLI::App* at = &app_;
    while (!at->get_subcommands().empty()) {
      at = at->get_subcommands().front();
      command += " " + at->get_name();
    }
    std::string what = e.what();
    if (e.get_exit_code() == static_cast<int>(CLI::ExitCodes::ExtrasError))
      what = too_many(*at, what.substr(what.rfind(':') + 2));
    if (const std::size_t found = what.find(" not in {"); found != std::string::npos) what = no_choice(what, found);
    if (const std::size_t found = what.find(" not in range 0.000000 to 1797"); found != std::string::npos)
      what = what.substr(0, found) + " is too small";  // instead of the 309 digits of the largest number
    if (app_.get_subcommands().empty() && !app_.remaining().empty()) what = no_command(app_.remaining().front());
    return what + (what.ends_with('?') ? " '" : "; '") + command + " --help' tells what there is";
  }

  int exit(const CLI::Error& e) const { return app_.exit(e); }

 private:
  /// Of "command: nonsense not in {start,pause}", whose choices begin behind `at`.
  static std::string no_choice(const std::string& what, std::size_t at) {
    const std::size_t begin = what.find('{', at) + 1;
    std::istringstream in(what.substr(begin, what.rfind('}') - begin));
    std::vector<std::string> known;
    for (std::string one; std::getline(in, one, ',');) known.push_back(one);
    const std::size_t colon = what.find(": ");
    const std::size_t word = colon < at ? colon + 2 : 0;
    const std::string given = what.substr(word, at - word);
    return what.substr(0, word) + "'" + given + "' is none of " + hal::listed(known) + hal::did_you_mean(given, known);
  }
  /// Of words that the command does not take, the last first as CLI11 lists them: an option before a word.
  static std::string too_many(const CLI::App& command, const std::string& listed) {
    std::istringstream in(listed);
    const std::vector<std::string> words(std::istream_iterator<std::string>(in), {});
    const auto option = std::ranges::find_if(words, [](const std::string& word) { return word.starts_with('-'); });
    if (option == words.end()) return "'" + words.back() + "' is a word too many";
    const std::string name = option->substr(0, option->find('='));
    std::vector<std::string> known;
    for (const CLI::Option* one : command.get_options()) {
      for (const std::string& long_name : one->get_lnames()) known.push_back("--" + long_name);
    }
    return "there is no option '" + name + "'" + hal::did_you_mean(name, known);
  }
  std::string no_command(const std::string& word) const {
    const auto others = launcher_commands();
    if (std::ranges::find(others, word, &hal::CommandType::name) != others.end())
      return "'" + word + "' is a command of the launcher at the top of a checkout";
    std::vector<std::string> known;
    for (const Candidate& one : candidates_) known.push_back(one.app->get_name());
    return "there is no command '" + word + "'" + hal::did_you_mean(word, known);
  }

  CLI::App app_;
  Libraries plugins_;  // for help: they are taken from the line before
  std::deque<Candidate> candidates_;
};

/// The words of a call, those of --plugin before the command apart.
struct Words {
  Libraries plugins;
  std::vector<std::string> rest;

  Words(int argc, char** argv) {
    constexpr std::string_view kPlugin = "--plugin";
    const std::vector<std::string> all(argv + 1, argv + argc);
    std::size_t at = 0;
    for (; at < all.size(); ++at) {
      if (all[at] == kPlugin && at + 1 < all.size())
        plugins.push_back(all[++at]);
      else if (all[at].starts_with("--plugin="))
        plugins.push_back(all[at].substr(kPlugin.size() + 1));
      else
        break;
    }
    rest.assign(all.begin() + static_cast<std::ptrdiff_t>(at), all.end());
  }
  std::string_view command() const {
    if (rest.empty() || rest.front().starts_with('-')) return {};
    return rest.front();
  }
  bool asks_what_there_is() const { return rest.empty() || rest.front() == "-h" || rest.front() == "--help"; }
};

/// Makes the commands known that the words may name. The libraries before a command of the program are for it.
hal::Status find_commands(Words& words, KnownCommands& known) {
  if (hal::Status loaded = known.load_module_of(words.command()); !loaded.ok()) return loaded;
  if (!known.of(words.command()).empty()) {
    for (const std::string& library : words.plugins) words.rest.insert(words.rest.end(), {"--plugin", library});
    return words.plugins.empty() ? hal::Status() : known.judge(words.plugins);
  }
  if (hal::Status opened = known.open(words.plugins); !opened.ok()) return opened;
  const bool found = !known.of(words.command()).empty();
  if (found || (words.command().empty() && !words.asks_what_there_is())) return {};
  return known.look_in_folders(words.command());
}

int run_candidate(Candidate& candidate, const KnownCommands& known) {
  constexpr int kLast = kDifferent;
  const hal::Result<int> done = calling(candidate, [&] { return candidate.command->run(known); });
  const std::string who = candidate.is_plugins() ? candidate.name() + ": " : "";
  if (!done.ok()) return complain(kFailedRunning, who + done.error().message);
  if (candidate.is_plugins() && (done.value() < 0 || done.value() > kLast))
    return complain(kFailedRunning, who + "it returned " + std::to_string(done.value()) + ", which is no exit code");
  if (std::fflush(stdout) != 0)
    return complain(kFailedRunning, std::string("standard output: ") + std::strerror(errno));
  return done.value();
}

int parse_and_run(Line& line, const Words& words, const KnownCommands& known) {
  try {
    return run_candidate(line.parse(words.rest), known);
  } catch (const CLI::Success& e) {
    return line.exit(e);
  } catch (const CLI::ParseError& e) {
    if (!words.rest.empty()) return complain(kWrongUsage, line.complaint(e));
    line.exit(e);  // a name alone: all that there is
    return kWrongUsage;
  }
}

}  // namespace

int run_command_line(int argc, char** argv, const Program& program) {
  std::signal(SIGXFSZ, SIG_IGN);  // a file that grows too large is an error as any other
  try {
    KnownCommands known(program.register_commands);
    Words words(argc, argv);
    if (const hal::Status good = find_commands(words, known); !good.ok())
      return complain(kBadInput, good.error().message);
    Line line(program);
    std::vector<const hal::CommandType*> types = known.of(words.command());
    if (types.empty()) types = by_group(known.all());
    for (const hal::CommandType* type : types) line.add(*type, known.origin_of(*type));
    return parse_and_run(line, words, known);
  } catch (const std::bad_alloc&) {
    return complain(kFailedRunning, "out of memory");
  } catch (const std::exception& e) {
    return complain(kFailedRunning, e.what());
  }
}

std::string flaw_of_line(const hal::CommandType& type) {
  try {
    CLI::App app;
    hal::CommandLine line;
    const auto command = type.make();
    if (command == nullptr) return "it makes none";
    command->describe(line);
    add_line(app, line);
    for (const Argument& a : line.arguments()) {
      if (a.text.empty() && !a.is_hidden) return "what '" + a.names + "' is for is not said";
    }
    return {};
  } catch (const std::exception& e) {
    return e.what();
  } catch (...) {
    return "it threw what is no std::exception";
  }
}

}  // namespace tandem::app
