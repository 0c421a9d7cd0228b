# For the mutated copy: contracts and the bounds of arrays are checked in the libraries, as in the preset
# "debug", but optimised; tests and command stay as in the release. What switches look like, and tests that are not
# read together as in the release, is nothing to warn of.
add_compile_options(-w)
foreach(library models reference fast certificate diagnosis)
  cmake_language(EVAL CODE "
    cmake_language(DEFER CALL target_compile_options shapeid_${library} PRIVATE
                   -O2 -UNDEBUG -D_GLIBCXX_ASSERTIONS)")
endforeach()
