# For the preset "coverage": the libraries count the lines and branches that tests come past. At -O1,
# for counts that belong to lines.
foreach(library models reference fast certificate diagnosis)
  cmake_language(EVAL CODE "
    cmake_language(DEFER CALL target_compile_options shapeid_${library} PRIVATE --coverage -O1)
    cmake_language(DEFER CALL target_link_options shapeid_${library} INTERFACE --coverage)")
endforeach()
