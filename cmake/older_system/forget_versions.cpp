// SPDX-License-Identifier: BSD-3-Clause
// forget_versions LIBRARY VERSION...: a library (ELF, 64 bits) no longer asks for these versions of
// others' symbols. The loader then takes such a symbol from whoever defines it. To mark the
// versions weak would do for the loader, too, but at every start of a program it says that they are
// not there. The tables:
// https://refspecs.linuxfoundation.org/LSB_5.0.0/LSB-Core-generic/LSB-Core-generic/symversion.html
#include <elf.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iostream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

class Library {
 public:
  explicit Library(std::vector<char> bytes) : bytes_(std::move(bytes)) {
    const auto& head = at<Elf64_Ehdr>(0);
    if (std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0 || head.e_ident[EI_CLASS] != ELFCLASS64)
      throw std::runtime_error("not an ELF file of 64 bits");
    for (std::size_t i = 0; i < head.e_shnum; ++i)
      sections_.push_back(at<Elf64_Shdr>(head.e_shoff + i * head.e_shentsize));
  }

  void forget(const std::vector<std::string>& versions) {
    for (const Elf64_Shdr& section : sections_) {
      if (section.sh_type != SHT_GNU_verneed) continue;
      std::size_t file = section.sh_offset;
      for (Elf64_Word left = section.sh_info; left > 0; --left) {
        forget(file, sections_.at(section.sh_link).sh_offset, versions);
        file += at<Elf64_Verneed>(file).vn_next;
      }
    }
  }

  const std::vector<char>& bytes() const { return bytes_; }

 private:
  // Takes these versions out of the list of those needed of one file
  void forget(std::size_t file, std::size_t names, const std::vector<std::string>& versions) {
    auto& need = at<Elf64_Verneed>(file);
    std::vector<std::size_t> kept;
    std::size_t place = file + need.vn_aux;
    for (int left = need.vn_cnt; left > 0; --left) {
      const auto& version = at<Elf64_Vernaux>(place);
      const std::string name = &at<char>(names + version.vna_name);
      if (std::find(versions.begin(), versions.end(), name) == versions.end())
        kept.push_back(place);
      else
        without_version(version.vna_other);
      place += version.vna_next;
    }
    if (kept.empty()) throw std::runtime_error("no version would be left of one of its files");
    need.vn_cnt = static_cast<Elf64_Half>(kept.size());
    need.vn_aux = static_cast<Elf64_Word>(kept.front() - file);
    for (std::size_t i = 0; i < kept.size(); ++i)
      at<Elf64_Vernaux>(kept[i]).vna_next =
          i + 1 < kept.size() ? static_cast<Elf64_Word>(kept[i + 1] - kept[i]) : 0;
  }

  // The symbols of this version are symbols of no version
  void without_version(Elf64_Half version) {
    for (const Elf64_Shdr& section : sections_) {
      if (section.sh_type != SHT_GNU_versym) continue;
      for (std::size_t i = 0; i < section.sh_size / sizeof(Elf64_Half); ++i) {
        auto& of_symbol = at<Elf64_Half>(section.sh_offset + i * sizeof(Elf64_Half));
        if (of_symbol == version) of_symbol = VER_NDX_GLOBAL;
      }
    }
  }

  template <class T>
  T& at(std::size_t offset) {
    if (offset > bytes_.size() || bytes_.size() - offset < sizeof(T))
      throw std::runtime_error("the file is cut off");
    return *reinterpret_cast<T*>(bytes_.data() + offset);
  }

  std::vector<char> bytes_;
  std::vector<Elf64_Shdr> sections_;
};

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) throw std::runtime_error("expected LIBRARY VERSION...");
  std::fstream file(argv[1], std::ios::in | std::ios::out | std::ios::binary);
  Library library({std::istreambuf_iterator<char>(file), {}});
  library.forget({argv + 2, argv + argc});
  file.clear();
  file.seekp(0);
  file.write(library.bytes().data(), static_cast<std::streamsize>(library.bytes().size()));
  if (!file.flush()) throw std::runtime_error("cannot write the file");
} catch (const std::exception& error) {
  std::cerr << "forget_versions: " << argv[1] << ": " << error.what() << '\n';
  return 1;
}
