#include "app/study/register.hpp"

#include "app/command/command.hpp"
#include "app/command/listing.hpp"
#include "study/study.hpp"

namespace tandem::app {
namespace {

constexpr Listing kElements = {
    "elements",
    [](const hal::Catalog&) {
      fmt::print("elements of studies:\n");
      for (const core::ElementManual& m : study::study_manuals()) fmt::print("  {:<22} {}\n", m.name, m.doc);
    },
    [](const hal::Catalog&, const std::string& name) { return describe_elements(study::study_manuals(), name); }};

}  // namespace

void register_study(hal::Registrar& registrar) {
  registrar.add(sweep_command);
  registrar.add(plot_command);
  registrar.add(kElements);
  registrar.add(study_file);
}

}  // namespace tandem::app
