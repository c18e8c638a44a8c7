#include "core/physics/dynamics2d/params.hpp"

namespace tandem::core::box2d {
namespace {

/// Chipmunk's, which ARGoS 3 is built on. Box2D finds neighbours in a tree and needs none.
struct SpatialHash {
  double cell_size_m = 0.1;
  std::int64_t cell_num = 1000;

  void describe(hal::ParamVisitor& v) {
    v.number("cell_size", cell_size_m, hal::unit::m, {0.0, 1e6}, "Read for ARGoS 3's files, without effect.");
    v.integer("cell_num", cell_num, {0, 1e9}, "Read for ARGoS 3's files, without effect.");
  }
};

}  // namespace

std::shared_ptr<const Params> read_params(const Element& options, Problems& problems) {
  auto params = std::make_shared<Params>();
  ElementReader reader(options, problems, {"id", "regions"});
  params->describe(reader);
  reader.finish();
  for (const Element& child : options.children) {
    if (child.name == "boundaries") continue;
    if (child.name == "spatial_hash") {
      SpatialHash hash;
      ElementReader hash_reader(child, problems);
      hash.describe(hash_reader);
      hash_reader.finish();
      continue;
    }
    problems.push_back({options.file, child.line,
                        "<dynamics2d> may not hold <" + child.name + ">; it may hold: boundaries, spatial_hash",
                        false});
  }
  return params;
}

}  // namespace tandem::core::box2d
