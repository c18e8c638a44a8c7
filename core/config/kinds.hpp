// Reads the kinds of robots that files give: <kinds>, in an experiment or in a file of its own.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/scenario/scenario.hpp"
#include "hal/catalog.hpp"

namespace tandem::core {

/// Puts what is in the files of <kinds file="…"/> in the place of these elements, and all kinds into one <kinds>.
/// A file is looked for in the folder of the one that names it, then in the working directory. A file that is named
/// twice counts once. Problems: not there, no file of kinds, one that includes itself.
void include_kinds(Element& root, Problems& problems);

/// Reads the kinds of an experiment, or of a file of kinds, in their order. Then `root` shows every fact of each, what
/// it has from the kind that it is like, too. Where there is an error, what is given back can be used to find further
/// ones. `catalog` has the parts that kinds are built of, and the robots that they may be like.
std::vector<KindConfig> read_kinds(Element& root, const hal::Catalog& catalog, Problems& problems);

/// Reads a file of kinds, as <kinds file="…"/> does. Nothing when there is an error.
std::optional<std::vector<KindConfig>> read_kinds_file(const std::string& path, const hal::Catalog& catalog,
                                                       Problems& problems);

/// The element from which a file gives this kind: every fact with its source.
Element element_of(const hal::RobotKind& kind, const std::string& bridge = {});

/// A file with these kinds, as text.
std::string kinds_file(const std::vector<Element>& kinds);

}  // namespace tandem::core
