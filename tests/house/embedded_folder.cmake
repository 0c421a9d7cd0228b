# Another project that has this one as a folder (FetchContent, a submodule) and asks for no standard of C++: what
# it links brings its own. One file is compiled, no library.
# Called by ctest: cmake -DWORK=... -DSOURCE=... -P embedded_folder.cmake
file(REMOVE_RECURSE ${WORK})
file(COPY ${SOURCE}/tests/house/consumer/main.cpp DESTINATION ${WORK})
file(WRITE ${WORK}/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(embeds LANGUAGES C CXX)\n"
     "add_subdirectory(${SOURCE} shapeid)\nadd_executable(embeds main.cpp)\n"
     "target_link_libraries(embeds PRIVATE shapeid::reference shapeid::fast)\n")
include(${CMAKE_CURRENT_LIST_DIR}/must.cmake)
must(${CMAKE_COMMAND} -S ${WORK} -B ${WORK}/build -G Ninja)
must(${CMAKE_COMMAND} --build ${WORK}/build --target CMakeFiles/embeds.dir/main.cpp.o)
