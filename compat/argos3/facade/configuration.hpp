// Elements of experiment files as ARGoS' nodes.
#pragma once
#include <argos3/core/utility/configuration/argos_configuration.h>
#include <memory>

#include "hal/element.hpp"

namespace tandem::compat::argos3 {

/// A node with the same attributes and children.
std::unique_ptr<ticpp::Element> to_node(const hal::Element& element);

}  // namespace tandem::compat::argos3
