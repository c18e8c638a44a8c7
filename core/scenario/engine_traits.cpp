#include "core/scenario/engine_traits.hpp"

#include <utility>

namespace tandem::core {

std::string engines_that(const hal::Catalog& catalog, const std::function<bool(const EngineTraits&)>& fit) {
  std::string all;
  for (const KnownEngine* engine : catalog.all<KnownEngine>()) {
    if (fit(engine->traits)) all += (all.empty() ? "" : ", ") + std::string(engine->kind);
  }
  if (!all.empty()) return all;
  for (const std::string& name : catalog.elsewhere(KnownEngine::kCategory))
    all += (all.empty() ? "one of these, if it can (they are not loaded): " : ", ") + name;
  return all.empty() ? "none of this program's" : all;
}

std::string words_of(JointKinds kinds) {
  std::string all;
  for (const auto& [kind, word] : {std::pair{JointKind::Fixed, "fixed"}, std::pair{JointKind::Turning, "turning"},
                                   std::pair{JointKind::Sliding, "sliding"}}) {
    if ((kinds & bit(kind)) != 0) all += (all.empty() ? "" : " and ") + std::string(word);
  }
  return all;
}

}  // namespace tandem::core
