// The commands that one call of the program may name, and everything that they are handed.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "hal/command.hpp"
#include "hal/plugin_loader.hpp"

namespace tandem::app {

/// By heading, in the order of help; under each as they were. Commands of a command stand under its heading.
std::vector<const hal::CommandType*> by_group(std::vector<const hal::CommandType*> types);

/// Begins with the program's own commands; libraries are opened when they are asked for.
class KnownCommands final : public hal::CommandContext {
 public:
  explicit KnownCommands(void (*register_commands)(hal::Registrar& registrar));

  /// All, in the order in which they were registered.
  std::vector<const hal::CommandType*> all() const;
  /// Those whose first word this is: "plugin", "plugin new", "plugin check".
  std::vector<const hal::CommandType*> of(std::string_view word) const;
  /// "tandem", or the library that brought it.
  std::string origin_of(const hal::CommandType& type) const { return current().origin_of(&type); }

  /// Loads the module that brings commands with this word, if one does; it is built where that is needed.
  hal::Status load_module_of(std::string_view word);
  /// Opens these libraries, with all that they bring.
  hal::Status open(const std::vector<std::string>& libraries);
  /// Refuses libraries whose commands have names that there are already. What brings no commands is not opened.
  hal::Status judge(const std::vector<std::string>& libraries);
  /// Opens what brings commands in the plug-in folders; nothing else of them runs. Says which cannot be opened. Error:
  /// two of them have a command that begins with `word`.
  hal::Status look_in_folders(std::string_view word);

  const hal::Catalog& catalog() const override { return loader().catalog(); }

 private:
  const hal::Catalog& current() const { return loader_ ? loader_->catalog() : inside_; }
  hal::PluginLoader& loader() const;
  bool brings(const std::string& library, std::string_view word) const;

  void (*register_commands_)(hal::Registrar& registrar);
  hal::Catalog inside_;                                // the program's commands alone
  mutable std::unique_ptr<hal::PluginLoader> loader_;  // null until more than those is wanted
};

}  // namespace tandem::app
