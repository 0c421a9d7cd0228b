// The files of the project, as text.
#pragma once

#include <filesystem>

#include "shapeid/tests/support/files.hpp"

inline const std::filesystem::path root = SHAPEID_SOURCE_DIR;

using shapeid::test::text_of;
