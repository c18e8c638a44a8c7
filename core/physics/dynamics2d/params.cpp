#include "core/physics/dynamics2d/params.hpp"

namespace tandem::core::box2d {

std::shared_ptr<const Params> read_params(const Element& options, Problems& problems) {
  return std::make_shared<Params>(read_settings<Params>(options, problems, {"id", "regions"}, {"boundaries"}));
}

}  // namespace tandem::core::box2d
