# For the mutated copy: what switches look like is nothing to warn of.
foreach(library models reference fast certificate)
  cmake_language(EVAL CODE "cmake_language(DEFER CALL target_compile_options shapeid_${library} PRIVATE -w)")
endforeach()
