# Everything checked at run time by the compiler's sanitizers, assertions of our libraries included;
# see tests/sanitizers.sh.
if(MESHGROW_SANITIZE STREQUAL "address")
  set(checks -fsanitize=address,undefined,float-cast-overflow -fno-sanitize-recover=all)
elseif(MESHGROW_SANITIZE STREQUAL "thread")
  set(checks -fsanitize=thread)
else()
  message(FATAL_ERROR "MESHGROW_SANITIZE is \"${MESHGROW_SANITIZE}\": give address or thread.")
endif()
add_compile_options(-O1 -g1 -fno-omit-frame-pointer ${checks})
add_compile_definitions(_GLIBCXX_ASSERTIONS)
add_link_options(${checks})
