# Fails if ARCHIVE asks for a symbol of a library or folder that it may not know.
# Called by ctest: cmake -DNM=nm -DARCHIVE=libshapeid_fast.a -P archive_symbols.cmake
cmake_policy(VERSION 3.25)
set(foreign "(fmt|YAML|tinyxml2|nlohmann|CLI|SimTK|ceres)::")
set(folders "shapeid::(reference|diagnosis|certificate|app)::")
set(of_c "(^| )(gz[a-z]+|csv_[a-z_]+|__gmp[a-z_]+|MPI_[A-Za-z_]+)$")
execute_process(COMMAND ${NM} --demangle --undefined-only ${ARCHIVE}
                OUTPUT_VARIABLE symbols RESULT_VARIABLE status)
if(NOT status EQUAL 0 OR symbols STREQUAL "")
  message(FATAL_ERROR "${ARCHIVE} has no symbols that can be read")
endif()
string(REPLACE ";" "," symbols "${symbols}")
string(REPLACE "\n" ";" lines "${symbols}")
list(FILTER lines INCLUDE REGEX "${foreign}|${folders}|${of_c}")
list(REMOVE_DUPLICATES lines)
if(lines)
  string(REPLACE ";" "\n" lines "${lines}")
  message(FATAL_ERROR "${ARCHIVE} asks for\n${lines}")
endif()
