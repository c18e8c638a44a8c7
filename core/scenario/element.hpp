// The elements of experiment files and their readers (hal/element.hpp), by the names that all of core uses.
#pragma once
#include "hal/element.hpp"

namespace tandem::core {

using hal::cannot_hold;
using hal::closest;
using hal::count_ignored;
using hal::did_you_mean;
using hal::Element;
using hal::ElementReader;
using hal::ElementWriter;
using hal::has_errors;
using hal::listed;
using hal::ManualWriter;
using hal::Problem;
using hal::problem_at;
using hal::Problems;
using hal::read_settings;
using hal::refuse_ignored;
using hal::to_text;
using hal::unread_at;

}  // namespace tandem::core
