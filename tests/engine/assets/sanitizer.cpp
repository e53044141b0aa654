// libpng leaves OpenImageIO 2.4's read callback by longjmp, past the string of geterror() that then leaks,
// once per damaged PNG. It is theirs; everything else that leaks is ours and counts.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:ImageInput::geterror";
}
