// libpng leaves OpenImageIO 2.4's read callback by longjmp, past a string that then leaks, once per damaged
// PNG. It is theirs; everything else that leaks is ours and counts.
extern "C" const char* __lsan_default_suppressions() {
  return "leak:PngReadCallback";
}
