// Elements of experiment files as ARGoS' nodes.
#pragma once
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <memory>

#include "hal/element.hpp"

namespace tandem::compat::argos3 {

/// A node with the same attributes and children. `lines`: those of the element are lines of a file.
std::unique_ptr<ticpp::Element> to_node(const hal::Element& element, bool lines);

}  // namespace tandem::compat::argos3
