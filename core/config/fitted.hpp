// Reads fitted parameters of simulated robots: <fitted>, in an experiment or in a file of its own.
#pragma once
#include <string>
#include <vector>

#include "core/scenario/element.hpp"
#include "hal/robot_kind.hpp"

namespace tandem::core {

/// Puts what is in the file of <fitted file="…"/> into that element. The file is looked for in the folder of the one
/// that names it, then in the working directory. Problems: not there, no file of fitted parameters.
void include_fitted(Element& root, Problems& problems);

/// The parts that were fitted to robots of one kind.
struct FittedKind {
  std::string kind;
  std::vector<hal::AnyPart> parts;
};

/// A file with these, as text.
std::string fitted_file(std::vector<FittedKind> kinds);

}  // namespace tandem::core
