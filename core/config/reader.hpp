// Reads experiment files: ARGoS 3's vocabulary, and what Tandem adds to it.
#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/scenario/scenario.hpp"

namespace tandem::core {

/// What this program has, so that the reader can judge names.
struct KnownNames {
  std::vector<std::string> robots;    ///< kinds, e.g. "e-puck"
  std::vector<std::string> engines;   ///< kinds
  std::vector<std::string> sensors;   ///< port names
  std::vector<std::string> actuators;
};

/// Reads and checks `path` with `overrides` ("path=value") applied. All problems are collected, each with its line; nothing
/// is returned when there is an error among them. Relative paths in the file are resolved against its folder.
std::optional<Scenario> read_experiment(const std::string& path, const std::vector<std::string>& overrides, const KnownNames& known,
                                        Problems& problems);

/// The same from text; `name` stands for the file in messages.
std::optional<Scenario> read_experiment_text(const std::string& text, const std::string& name,
                                             const std::vector<std::string>& overrides, const KnownNames& known, Problems& problems);

/// Our name of an ARGoS device ("epuck_proximity" -> "proximity"); unknown names come back as they are.
std::string device_name(std::string_view argos_name, bool sensor);

/// One element of the schema, for the manual.
struct ElementManual {
  std::string_view name;
  std::string_view parent;            ///< empty: the root
  std::string_view doc;
  std::string attributes;             ///< one line each
  std::vector<std::string> children;
};
std::vector<ElementManual> element_manuals();

}  // namespace tandem::core
