// Reads experiment files: ARGoS 3's vocabulary, and Tandem's additions.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"
#include "hal/port.hpp"

namespace tandem::core {

/// An experiment file whose names are not judged yet: the plug-ins that it names come first.
struct ExperimentFile {
  Element root;
  Problems problems;  ///< so far
};

/// Reads `path`, with `overrides` ("path=value") applied. Nothing, and `problems`, when it is no XML.
std::optional<ExperimentFile> open_experiment(const std::string& path, const std::vector<std::string>& overrides,
                                              Problems& problems);
/// The same from text; `name` stands for the file in messages, and paths are relative to its folder.
std::optional<ExperimentFile> open_experiment_text(const std::string& text, const std::string& name,
                                                   const std::vector<std::string>& overrides, Problems& problems);
/// The libraries of its <plugins>, in their order.
std::vector<PluginConfig> plugins_of(const Element& root);
/// Whether a robot of the file has a <bridge>, leaving out those of the ids `without`. Other problems are for later.
bool names_real_robots(const Element& root, const std::vector<std::string>& without);

/// Reads and checks a file, whose robots, engines and devices are to be in `catalog`. All problems are collected, each
/// with its line and in the order of the file; nothing is returned when there is an error among them. Paths of files in
/// it are relative to the working directory, or else to its own folder.
std::optional<Scenario> read_experiment(ExperimentFile file, const hal::Catalog& catalog, Problems& problems);

/// The two steps in one, for files without plug-ins.
std::optional<Scenario> read_experiment(const std::string& path, const std::vector<std::string>& overrides,
                                        const hal::Catalog& catalog, Problems& problems);

/// The same from text; `name` stands for the file in messages.
std::optional<Scenario> read_experiment_text(const std::string& text, const std::string& name,
                                             const std::vector<std::string>& overrides, const hal::Catalog& catalog,
                                             Problems& problems);

/// The scenario as an experiment file with every default written out. Reads back as the same scenario.
std::string effective_settings(const Scenario& scenario);

/// Our name of an ARGoS device: one that begins with the name of a kind of robot, without its hyphens, and "_" loses
/// that when the catalog has the device that remains. Unknown names come back as they are.
std::string device_name(std::string_view argos_name, hal::Role role, const hal::Catalog& catalog);

/// One element of the schema, for the manual.
struct ElementManual {
  std::string name;    ///< as written; "configuration" stands for the names of controllers
  std::string parent;  ///< in which it may stand, "box or cylinder"; empty: the root
  std::string doc;
  std::string attributes;             ///< which must be given, then all as ManualWriter lists them
  std::vector<std::string> children;  ///< "*": anything
};

/// The manual of every element, with one entry for every kind of robot and of engine in `catalog`.
std::vector<ElementManual> element_manuals(const hal::Catalog& catalog);

}  // namespace tandem::core
