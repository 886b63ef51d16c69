# SPDX-License-Identifier: MIT
# Debian and Ubuntu packages without root. To be sourced after folder.sh.
#
# A private view of the archive: apt itself, its signatures checked as ever, but with sources,
# lists and caches in a folder of our own. The apt configuration and lists of the machine stay as
# they are. Only the address of the mirror, and a proxy if there is one, are taken from them.

os_release=/etc/os-release
keyrings=/usr/share/keyrings

# The distribution in one word: debian, ubuntu (derivatives count as what they derive from) or "".
distribution() (
    ID='' ID_LIKE=''
    [[ -r $os_release ]] && . "$os_release"
    case " $ID $ID_LIKE " in
        *' ubuntu '*) echo ubuntu ;;
        *' debian '*) echo debian ;;
    esac
)

# The code name of the release that the machine runs, in the words of that distribution.
release() (
    . "$os_release"
    if [[ $(distribution) == ubuntu ]]; then
        echo "${UBUNTU_CODENAME:-${VERSION_CODENAME:-}}"
    else
        echo "${VERSION_CODENAME:-}"
    fi
)

# The releases worth looking into, best first. Debian: the one that everything was tried with.
# Ubuntu: the machine's own, and the first with long support that has MicroPython 1.25 or newer.
releases() {
    case $(distribution) in
        debian) printf '%s\n' trixie "$(release)" ;;
        ubuntu) printf '%s\n' "$(release)" resolute ;;
    esac | awk 'NF && !seen[$0]++'
}

# The mirrors that the machine itself takes its release from. Security mirrors have a release name
# of their own and so drop out; a third party's archive may stay, and fails the signature check.
# "No release info" makes apt answer on a machine whose lists were never fetched.
mirrors() {
    apt-get indextargets --no-release-info --format '$(RELEASE) $(COMPONENT) $(SITE)' 2>/dev/null |
        awk -v release="$(release)" '
            $2 == "main" && ($1 == release || $1 ~ /^(oldstable|stable|testing|unstable|sid)$/) &&
            $3 !~ /^cdrom/ && !seen[$3]++ { print $3 }'
}

# The sources of the private view: KIND is deb or deb-src.
sources() {
    local kind=$1 release=$2 architecture=$3 options='' components=main keyring mirror
    for keyring in "$keyrings/$(distribution)-archive-keyring".{gpg,pgp}; do
        # Without the file, apt falls back on the keys that it trusts for everything.
        [[ -r $keyring ]] && options="signed-by=$keyring" && break
    done
    [[ $kind == deb ]] && options+=" arch=$architecture target=Packages lang=none"
    [[ $(distribution) == ubuntu ]] && components='main universe'
    while read -r mirror; do
        echo "$kind [$options] $mirror $release $components"
    done < <(mirrors)
}

# packages_open FOLDER KIND RELEASE [ARCHITECTURE]
#   Opens a private view in FOLDER and reads the lists of RELEASE. KIND is deb or deb-src.
#   Returns 0 also when nothing could be read: then packages_version finds nothing.
packages_open() {
    local folder=$1 kind=$2 release=$3 architecture=${4:-$(dpkg --print-architecture)}
    mkdir -p "$folder"/{lists,cache/archives}/partial &&
        : >"$folder/status" &&
        sources "$kind" "$release" "$architecture" >"$folder/sources.list" &&
        cat >"$folder/apt.conf" <<CONFIGURATION
Dir::State "$folder";
Dir::State::lists "$folder/lists";
Dir::State::status "$folder/status";
Dir::Cache "$folder/cache";
Dir::Etc::sourcelist "$folder/sources.list";
Dir::Etc::sourceparts "/dev/null";
Dir::Etc::preferences "/dev/null";
Dir::Etc::preferencesparts "/dev/null";
#clear APT::Architectures;
APT::Architectures { "$architecture"; };
APT::Architecture "$architecture";
// The machine's pinning and its actions after an update are about the machine, not about us.
#clear APT::Default-Release;
#clear APT::Update::Pre-Invoke;
#clear APT::Update::Post-Invoke;
#clear APT::Update::Post-Invoke-Success;
// The folder is ours alone: apt must not change to a user who may not enter it.
APT::Sandbox::User "root";
Acquire::Retries "1";
Acquire::http::Timeout "20";
Acquire::https::Timeout "20";
CONFIGURATION
    [[ -s $folder/sources.list ]] || say "    apt on this machine names no mirror of its release"
    apt_get "$folder" update >"$folder/log" 2>&1 || true
}

# apt-get and apt-cache within the private view. `-c` is read after the machine's configuration
# (a file named by APT_CONFIG would be read before it, and lose against it).
apt_get() { apt-get -qq -c "$1/apt.conf" "${@:2}"; }
apt_cache() { apt-cache -q -c "$1/apt.conf" "${@:2}"; }

# packages_version FOLDER PACKAGE: the newest version that the view offers, nothing when none.
packages_version() {
    {
        apt_cache "$1" show --no-all-versions "$2" || apt_cache "$1" showsrc "$2"
    } 2>/dev/null | awk '$1 == "Version:" { print $2; exit }'
}

# packages_download FOLDER WHAT...: `download PACKAGE...` or `source PACKAGE`, as for apt-get.
# The files land in FOLDER/downloads. A failure has been shown when this returns.
packages_download() {
    local folder=$1
    mkdir -p "$folder/downloads" && quietly "$folder/log" download_into "$@"
}

download_into() (
    cd "$1/downloads" && apt_get "$1" --download-only "${@:2}"
)

# packages_unpack FOLDER ROOT PACKAGE...: downloads the packages and unpacks them below ROOT.
packages_unpack() {
    local folder=$1 root=$2 package
    shift 2
    packages_download "$folder" download "$@" && mkdir -p "$root" || return
    for package in "$folder"/downloads/*.deb; do
        dpkg-deb -x "$package" "$root" || return
    done
}

# packages_dependencies FOLDER PACKAGE: the packages that PACKAGE itself asks for, one a line.
packages_dependencies() {
    apt_cache "$1" depends --no-recommends --no-suggests "$2" |
        awk '$1 ~ /^(Pre)?Depends:$/ { print $2 }'
}

# packages_starter FOLDER PROGRAM: writes FOLDER/PROGRAM, which runs what was unpacked below FOLDER
# with the loader and the libraries it was packed for, not those of the machine. It finds the folder
# that it stands in, so that the tree can be moved.
packages_starter() {
    local folder=$1 program=$2 loader libraries
    loader=$(cd "$folder" && find . -name 'ld-linux*.so.*' -path './*lib*' | head -n 1)
    libraries=$(cd "$folder" && find . -name 'lib*.so*' -regex '.*/lib/[^/]*-linux-gnu[^/]*/[^/]*' \
        -printf '$here/%h\n' | sort -u | awk '{ printf "%s%s", sep, $0; sep = ":" }')
    [[ -n $loader && -n $libraries ]] || return
    cat >"$folder/$program" <<STARTER
#!/bin/sh
# Runs $program with the loader and the libraries it was packed for, not those of the machine.
here=\${0%/*}
exec "\$here/$loader" --library-path "$libraries" "\$here/usr/bin/$program" "\$@"
STARTER
    chmod +x "$folder/$program"
}

# unpack_tar FILE FOLDER: the tar of a source package, without the folder that it begins with.
# Python takes the compression off, since it is needed anyhow and xz or bzip2 may be missing.
unpack_tar() {
    python3 -c '
import bz2, lzma, shutil, sys
opened = (bz2 if sys.argv[1].endswith(".bz2") else lzma).open(sys.argv[1])
shutil.copyfileobj(opened, sys.stdout.buffer)
' "$1" | tar -x -C "$2" --strip-components=1
}
