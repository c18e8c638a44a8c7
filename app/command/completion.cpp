// `tandem completion`: scripts by which shells complete what is typed, made from the descriptions of all commands.
#include <fmt/format.h>
#include <map>

#include "app/command/command.hpp"
#include "app/command/manuals.hpp"
#include "app/experiment/plugin_folders.hpp"
#include "app/experiment/plugins.hpp"
#include "app/module/modules.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {
namespace {

using hal::Argument;
using Manuals = std::vector<CommandManual>;

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, " "));
}

/// "file", "folder", "any", "words a b", or "list a b" where they are separated by commas.
std::string bash_value(const Argument& a, const hal::Catalog& catalog) {
  const std::vector<std::string> values = values_of(a, catalog);
  if (!values.empty()) return (a.is_list ? "list " : "words ") + joined(values);
  if (a.meaning == Argument::Meaning::File) return "file";
  return a.meaning == Argument::Meaning::Folder ? "folder" : "any";
}

/// Words of each command: of commands in it ("" holds all), of its options, and what follows them: "run --seed".
struct BashTables {
  std::map<std::string, std::vector<std::string>> commands, options;
  std::map<std::string, std::string> values;

  void add(const CommandManual& manual, const hal::Catalog& catalog) {
    commands[manual.group()].push_back(manual.last_word());
    options[manual.name].push_back("--help");
    int place = 0;
    for (const Argument& a : manual.line.arguments()) {
      if (a.is_hidden) continue;
      if (a.is_word()) {
        const std::string at = takes_several(a) ? "*" : std::to_string(++place);
        values[manual.name + " #" + at] = bash_value(a, catalog);
        continue;
      }
      for (const std::string& name : names_of(a)) {
        options[manual.name].push_back(name);
        if (!a.is_flag()) values[manual.name + " " + name] = bash_value(a, catalog);
      }
    }
  }
};

/// A function of the shell that prints what stands in a table, and fails where nothing does.
std::string bash_function(const std::string& name, const std::map<std::string, std::string>& table) {
  std::string text = name + "() {\n  case $1 in\n";
  for (const auto& [key, value] : table) text += fmt::format("    '{}') echo '{}' ;;\n", key, value);
  return text + "    *) return 1 ;;\n  esac\n}\n";
}

std::map<std::string, std::string> as_words(const std::map<std::string, std::vector<std::string>>& table) {
  std::map<std::string, std::string> all;
  for (const auto& [key, words] : table) all[key] = joined(words);
  return all;
}

constexpr std::string_view kBashFunction = R"bash(
_tandem() {
  local current=${COMP_WORDS[COMP_CWORD]} path='' place=0 option='' head='' word kind values i
  COMPREPLY=()
  for ((i = 1; i < COMP_CWORD; i++)); do # --name=value is three words here
    word=${COMP_WORDS[i]}
    if [[ $word == = ]]; then
      [[ -n $option ]] || i=$((i + 1))
    elif [[ -n $option ]]; then
      option=''
    elif [[ $word == -* ]]; then
      if _tandem_values "$path $word" >/dev/null; then option=$word; fi
    elif [[ $place -eq 0 && " $(_tandem_commands "$path") " == *" $word "* ]]; then
      path=${path:+$path }$word
    else
      place=$((place + 1))
    fi
  done
  [[ $current != = ]] || current=''
  if [[ -n $option ]]; then
    values=$(_tandem_values "$path $option")
  elif [[ $current == -* ]]; then
    values="words $(_tandem_options "$path")"
  elif [[ $place -eq 0 ]] && _tandem_commands "$path" >/dev/null; then
    values="words $(_tandem_commands "$path")"
  else
    values=$(_tandem_values "$path #$((place + 1))" || _tandem_values "$path #*" || echo file)
  fi
  kind=${values%% *}
  values=${values#* }
  case $kind in
    words) mapfile -t COMPREPLY < <(compgen -W "$values" -- "$current") ;;
    list)
      [[ $current != *,* ]] || head=${current%,*},
      mapfile -t COMPREPLY < <(compgen -P "$head" -W "$values" -- "${current##*,}")
      compopt -o nospace 2>/dev/null
      ;;
    file | folder)
      compopt -o filenames 2>/dev/null
      if [[ $kind == file ]]; then word=-f; else word=-d; fi
      mapfile -t COMPREPLY < <(compgen "$word" -- "$current")
      ;;
  esac
  return 0
}
complete -F _tandem tandem
)bash";

std::string bash_script(const Manuals& manuals, const hal::Catalog& catalog) {
  BashTables tables;
  tables.options[""] = {"--help", "--version", "--plugin"};
  tables.values[" --plugin"] = "file";
  for (const CommandManual& manual : manuals) tables.add(manual, catalog);
  return "# Completes the words of `tandem` in bash; made by `tandem completion bash`.\n" +
         bash_function("_tandem_commands", as_words(tables.commands)) +
         bash_function("_tandem_options", as_words(tables.options)) + bash_function("_tandem_values", tables.values) +
         std::string(kBashFunction);
}

/// Within single quotes, and in the brackets of _arguments.
std::string zsh_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') out += '\\';
    out += c == '\'' ? "'\\''" : std::string(1, c);
  }
  return out;
}

/// What _arguments is to do for a value.
std::string zsh_action(const Argument& a, const hal::Catalog& catalog) {
  const std::vector<std::string> values = values_of(a, catalog);
  if (!values.empty() && a.is_list) return "_values -s , value " + joined(values);
  if (!values.empty()) return "(" + joined(values) + ")";
  if (a.meaning == Argument::Meaning::File) return "_files";
  return a.meaning == Argument::Meaning::Folder ? "_files -/" : "";
}

std::string zsh_argument(const Argument& a, const hal::Catalog& catalog) {
  if (a.is_word())
    return fmt::format(" '{}:{}:{}'",
                       takes_several(a) ? "*"
                       : a.is_required  ? ""
                                        : ":",
                       zsh_text(a.names), zsh_action(a, catalog));
  std::string all;
  const std::vector<std::string> names = names_of(a);
  for (const std::string& name : names) {
    const std::string apart = a.is_repeatable ? "*" : names.size() > 1 ? "(" + joined(names) + ")" : "";
    const std::string_view joint = a.is_flag_or_number ? "=-" : a.is_flag() ? "" : name.size() == 2 ? "+" : "=";
    all += fmt::format(" '{}{}{}[{}]", apart, name, joint, zsh_text(a.text));
    if (!a.is_flag()) all += ":value:" + zsh_action(a, catalog);
    if (a.is_flag_or_number) all += "::number:";
    all += "'";
  }
  return all;
}

std::string zsh_function_name(const std::string& command) {
  std::string name = "_tandem";
  for (const char c : command) name += c == ' ' ? '_' : c;
  return command.empty() ? name : "_tandem_" + name.substr(7);
}

/// Of a command that holds others; "" is the whole program.
std::string zsh_group(const std::string& group, const Manuals& manuals) {
  std::string described, cases;
  for (const CommandManual& manual : manuals) {
    if (manual.group() != group) continue;
    described += fmt::format(" '{}:{}'", manual.last_word(), zsh_text(manual.summary));
    cases += fmt::format("        {}) {} ;;\n", manual.last_word(), zsh_function_name(manual.name));
  }
  const std::string_view own = group.empty() ? " '--version[Version]' '*--plugin=[Library]:library:_files'" : "";
  return fmt::format(R"({}() {{
  local context state line
  local -a commands=({})
  _arguments -C '(- *)--help[Help]'{} '1: :->command' '*:: :->words'
  case $state in
    command) _describe command commands ;;
    words)
      case $words[1] in
{}      esac
      ;;
  esac
}}
)",
                     zsh_function_name(group), described, own, cases);
}

std::string zsh_script(const Manuals& manuals, const hal::Catalog& catalog) {
  std::string text = "#compdef tandem\n# Completes the words of `tandem` in zsh; made by `tandem completion zsh`.\n";
  for (const CommandManual& manual : manuals) {
    if (manual.command == nullptr) {
      text += zsh_group(manual.name, manuals);
      continue;
    }
    text += zsh_function_name(manual.name) + "() {\n  _arguments '(- *)--help[Help]'";
    for (const Argument& a : manual.line.arguments()) {
      if (!a.is_hidden) text += zsh_argument(a, catalog);
    }
    text += "\n}\n";
  }
  return text + zsh_group("", manuals) +
         "if [[ $funcstack[1] == _tandem ]]; then _tandem \"$@\"; else compdef _tandem tandem; fi\n";
}

struct Completion {
  std::string shell;

  void describe(hal::CommandLine& line) {
    line.footer("The script knows what the plug-in folders have now. For bash: . <(tandem completion bash)");
    line.word("shell", shell, "Whose script is printed").required().one_of({"bash", "zsh"});
  }
};

int completion(const Completion& options, const hal::CommandContext& context) {
  load_built_modules();
  hal::PluginLoader loader(plugin_folders(), context.catalog(), on_demand());
  open_plugin_folders(loader);
  const Manuals manuals = command_manuals(loader.catalog());
  fmt::print("{}",
             options.shell == "bash" ? bash_script(manuals, loader.catalog()) : zsh_script(manuals, loader.catalog()));
  return kDone;
}

}  // namespace

constinit const hal::CommandType completion_command = hal::command_type<Completion, completion>(
    "completion", "Print a script by which a shell completes commands, options, files and names.",
    hal::command_group::kTools);

}  // namespace tandem::app
