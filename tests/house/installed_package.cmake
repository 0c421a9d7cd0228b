# Installs the libraries into a fresh folder, then builds and runs a project that finds them there.
# Called by ctest: cmake -DBUILD=... -DSOURCE=... -P installed_package.cmake
set(work ${BUILD}/installed_package)
file(REMOVE_RECURSE ${work})
function(must)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGV} failed (${status}):\n${out}")
  endif()
endfunction()
must(${CMAKE_COMMAND} --install ${BUILD} --prefix ${work}/prefix)
must(${CMAKE_COMMAND} -S ${SOURCE}/tests/house/consumer -B ${work}/build -G Ninja
     -DCMAKE_PREFIX_PATH=${work}/prefix -DCMAKE_BUILD_TYPE=Release)
must(${CMAKE_COMMAND} --build ${work}/build)
must(${work}/build/consumer)
must(${work}/build/consumer_of_certificates)
set(quadruped ${SOURCE}/models/robots/quadruped)
must(${work}/build/consumer_in_c ${quadruped}.urdf ${quadruped}.robot.yaml ${quadruped}.shapes.yaml)
