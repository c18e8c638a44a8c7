// The table of a class of parts, for plug-ins: `registrar.add(core::run_part_type<Stillness>("stillness", "…"))`.
#pragma once
#include <exception>
#include <memory>
#include <string_view>

#include "core/run/run.hpp"
#include "core/scenario/element.hpp"
#include "core/scenario/run_part_type.hpp"

namespace tandem::core {

/// Of class `T`, constructed from `(const T::Params&, Run&)`; what that throws is a problem of its element.
template <class T>
RunPartType run_part_type(std::string_view name, std::string_view summary) {
  return {name, summary, [](hal::ParamVisitor& visitor) { typename T::Params{}.describe(visitor); },
          [](const Element& element, Run& run, Problems& problems) -> std::unique_ptr<RunPart> {
            const std::size_t before = problems.size();
            const auto params = read_settings<typename T::Params>(element, problems);
            if (has_errors(problems, before)) return nullptr;
            try {
              return std::make_unique<T>(params, run);
            } catch (const std::exception& e) {
              problems.push_back(problem_at(element, e.what()));
              return nullptr;
            }
          }};
}

}  // namespace tandem::core
