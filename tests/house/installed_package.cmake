# Installs the libraries into a fresh folder, then builds and runs a project that finds them there.
# Called by ctest: cmake -DBUILD=... -DSOURCE=... -DFLAGS=... -P installed_package.cmake
set(work ${BUILD}/installed_package)
file(REMOVE_RECURSE ${work})
include(${CMAKE_CURRENT_LIST_DIR}/must.cmake)
function(must_fail words)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(status EQUAL 0 OR NOT out MATCHES "${words}")
    message(FATAL_ERROR "${ARGN} does not fail with \"${words}\" (${status}):\n${out}")
  endif()
endfunction()
must(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
must(${CMAKE_COMMAND} -S ${SOURCE}/tests/house/consumer -B ${work}/build -G Ninja
     -DCMAKE_PREFIX_PATH=${work}/prefix -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=${FLAGS})
must(${CMAKE_COMMAND} --build ${work}/build)
must(${work}/build/consumer)
must(${work}/build/consumer_of_certificates)
set(quadruped ${SOURCE}/models/robots/quadruped)
set(files ${quadruped}.urdf ${quadruped}.robot.yaml ${quadruped}.shapes.yaml)
must(${work}/build/consumer_in_c ${files})
must(${work}/build/consumer_of_both ${files})

# Of another alignment of Eigen the linker says that it is not the library's; the program would crash.
if(CMAKE_HOST_SYSTEM_PROCESSOR STREQUAL "x86_64")
  must(${CMAKE_COMMAND} -S ${SOURCE}/tests/house/consumer -B ${work}/wider -G Ninja
       -DCMAKE_PREFIX_PATH=${work}/prefix "-DCMAKE_CXX_FLAGS=${FLAGS} -mavx")
  foreach(target consumer consumer_of_both)
    must_fail("built_with_this_alignment_of_eigen" ${CMAKE_COMMAND} --build ${work}/wider --target ${target})
  endforeach()
endif()

# What is asked for by name, and what each name needs.
function(asks_for components)
  file(WRITE ${work}/asks/CMakeLists.txt "cmake_minimum_required(VERSION 3.25)\nproject(asks LANGUAGES CXX)\n"
       "find_package(shapeid REQUIRED ${components})\n"
       "add_executable(asks main.cpp)\ntarget_link_libraries(asks PRIVATE shapeid::fast)\n")
  file(WRITE ${work}/asks/main.cpp "int main() {}\n")
  file(REMOVE_RECURSE ${work}/asks/build)
endfunction()
set(asked ${CMAKE_COMMAND} -S ${work}/asks -B ${work}/asks/build -G Ninja -DCMAKE_PREFIX_PATH=${work}/prefix)
set(without_gmp -DCMAKE_DISABLE_FIND_PACKAGE_GMPXX=ON)
asks_for("COMPONENTS fast")
must(${asked} ${without_gmp})
asks_for("COMPONENTS fast nonsense")
must_fail("nonsense" ${asked})
asks_for("")
must_fail("GMP with its C\\+\\+ interface is missing" ${asked} ${without_gmp})
