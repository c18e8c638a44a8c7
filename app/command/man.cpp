// `tandem man`: manual pages, made from the descriptions of all commands.
#include <filesystem>
#include <fmt/format.h>

#include "app/command/command.hpp"
#include "app/command/manuals.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/experiment/plugins.hpp"
#include "app/module/modules.hpp"
#include "app/process/terminal.hpp"
#include "hal/output_file.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {
namespace {

using hal::Argument;
using Manuals = std::vector<CommandManual>;

/// As roff shows it letter by letter, at the beginning of a line, too.
std::string roff(const std::string& text) {
  std::string out = text.starts_with('.') || text.starts_with('\'') ? "\\&" : "";
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c == '\n' ? ' ' : c;
  }
  return out;
}

/// "tandem-plugin-new"
std::string page_name(const std::string& command) {
  std::string name = command.empty() ? "tandem" : "tandem-" + command;
  std::replace(name.begin(), name.end(), ' ', '-');
  return name;
}

std::string upper(std::string text) {
  for (char& c : text) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  return text;
}

std::string page_begin(const std::string& name, const std::string& summary) {
  return fmt::format(".TH {} 1 \"\" \"Tandem {}.{}.{}\" \"Tandem\"\n.SH NAME\n{} \\- {}\n", roff(upper(name)),
                     hal::kRelease.major_number, hal::kRelease.minor_number, hal::kRelease.patch, roff(name),
                     roff(summary.substr(0, summary.find_last_not_of('.') + 1)));
}

/// What stands for the value.
std::string value_name(const Argument& a) {
  if (!a.placeholder.empty()) return a.placeholder;
  if (a.meaning == Argument::Meaning::File) return "FILE";
  if (a.meaning == Argument::Meaning::Folder) return "FOLDER";
  const bool text = std::holds_alternative<std::string*>(a.value) ||
                    std::holds_alternative<std::optional<std::string>*>(a.value) ||
                    std::holds_alternative<std::vector<std::string>*>(a.value);
  return text ? "TEXT" : "NUMBER";
}

std::string default_of(const Argument& a) {
  return std::visit(
      [](auto* value) -> std::string {
        using T = std::remove_pointer_t<decltype(value)>;
        if constexpr (std::is_arithmetic_v<T> || std::is_same_v<T, std::string>)
          return fmt::format("{}", *value);
        else
          return "";
      },
      a.value);
}

/// What it takes, as sentences.
std::string constraints_of(const Argument& a) {
  std::string text;
  if (a.bound == Argument::Bound::Positive) text += " More than 0.";
  if (a.bound == Argument::Bound::NotNegative) text += " 0 or more.";
  if (a.bound == Argument::Bound::Range) text += fmt::format(" From {} to {}.", a.least, a.most);
  if (!a.choices.empty()) text += fmt::format(" One of {}.", fmt::join(a.choices, ", "));
  if (a.shows_default) text += fmt::format(" Default: {}.", default_of(a));
  if (a.is_list) text += " Separated by commas.";
  if (!a.needed.empty()) text += fmt::format(" Only with {}.", fmt::join(a.needed, ", "));
  if (!a.excluded.empty()) text += fmt::format(" Not with {}.", fmt::join(a.excluded, ", "));
  return text;
}

std::string item(const Argument& a) {
  std::string head;
  for (const std::string& name : names_of(a))
    head += fmt::format("{}\\f{}{}\\fR", head.empty() ? "" : ", ", a.is_word() ? 'I' : 'B', roff(name));
  if (a.is_flag_or_number) head += "[=\\fINUMBER\\fR]";
  if (!a.is_word() && !a.is_flag()) head += " \\fI" + roff(value_name(a)) + "\\fR";
  return fmt::format(".TP\n{}\n{}\n", head, roff(a.text + "." + constraints_of(a)));
}

std::string items(const CommandManual& manual, bool words, std::string_view title) {
  std::string text;
  for (const Argument& a : manual.line.arguments()) {
    if (a.is_word() == words && !a.is_hidden) text += item(a);
  }
  return text.empty() ? "" : fmt::format(".SH {}\n{}", title, text);
}

std::string synopsis(const CommandManual& manual) {
  std::string line = "[\\fIOPTIONS\\fR]";
  for (const Argument& a : manual.line.arguments()) {
    if (!a.is_word()) continue;
    const std::string word = "\\fI" + roff(a.names) + "\\fR" + (takes_several(a) ? " ..." : "");
    line += a.is_required ? " " + word : " [" + word + "]";
  }
  return fmt::format(".SH SYNOPSIS\n.B tandem {}\n{}\n", roff(manual.name), line);
}

/// A command's name and summary, for those of `group`; with headings where that is the whole program.
std::string commands_of(const Manuals& manuals, const std::string& group) {
  std::string text, heading;
  for (const CommandManual& m : manuals) {
    if (m.group() != group) continue;
    if (group.empty() && heading != m.heading) text += ".SS " + roff(m.heading) + "\n";
    heading = m.heading;
    text += fmt::format(".TP\n.BR {} (1)\n{}\n", roff(page_name(m.name)), roff(m.summary));
  }
  return text;
}

std::string page_of(const CommandManual& manual, const Manuals& manuals) {
  std::string text = page_begin(page_name(manual.name), manual.summary) + synopsis(manual);
  text += ".SH DESCRIPTION\n" + roff(manual.summary) + "\n";
  if (manual.of_launcher) text += ".PP\nThis is a command of the launcher at the top of a checkout.\n";
  if (!manual.line.footer().empty()) text += ".PP\n" + roff(manual.line.footer()) + "\n";
  text += items(manual, true, "ARGUMENTS") + items(manual, false, "OPTIONS");
  if (manual.command == nullptr) text += ".SH COMMANDS\n" + commands_of(manuals, manual.name);
  return text + ".SH SEE ALSO\n.BR tandem (1)\n";
}

std::string main_page(const Manuals& manuals) {
  return page_begin("tandem", "one controller drives simulated robots, real ones, and both together") +
         ".SH SYNOPSIS\n.B tandem\n[\\fB\\-\\-plugin\\fR \\fIFILE\\fR] \\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n"
         ".SH DESCRIPTION\nEach command has a page of its own.\n.SH COMMANDS\n" +
         commands_of(manuals, "") +
         ".SH EXIT STATUS\n0 done, 1 bad input, 2 wrong usage, 3 failed, 4 different.\n"
         ".SH ENVIRONMENT\n.TP\n.B TANDEM_PLUGIN_PATH\nFolders with plug\\-ins, separated by colons.\n";
}

struct Man {
  std::string folder = "man";

  void describe(hal::CommandLine& line) {
    line.word("folder", folder, "Where the pages are written: tandem.1, and one a command").show_default().folder();
  }
};

int man(const Man& options, const hal::CommandContext& context) {
  load_built_modules();
  hal::PluginLoader loader(plugin_folders(), context.catalog(), on_demand());
  open_plugin_folders(loader);
  const Manuals manuals = command_manuals(loader.catalog());
  const std::filesystem::path folder = options.folder;
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error)
    return complain(kBadInput, fmt::format("cannot make the folder '{}': {}", options.folder, error.message()));
  hal::Status written = hal::write_whole_file((folder / "tandem.1").string(), "manual page", main_page(manuals));
  for (const CommandManual& manual : manuals) {
    if (!written.ok()) break;
    written = hal::write_whole_file((folder / (page_name(manual.name) + ".1")).string(), "manual page",
                                    page_of(manual, manuals));
  }
  return written.ok() ? kDone : complain(kFailedRunning, written.error().message);
}

}  // namespace

constinit const hal::CommandType man_command =
    hal::command_type<Man, man>("man", "Write manual pages, one a command.", hal::command_group::kTools);

}  // namespace tandem::app
