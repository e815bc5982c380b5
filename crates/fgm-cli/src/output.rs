//! Files that appear whole or not at all.

use std::{
    fs,
    io::{self, BufWriter, Seek, Write},
    path::{Path, PathBuf},
    sync::{Mutex, PoisonError},
};

use fgm::gcode::ProgressLines;
use tempfile::NamedTempFile;

use crate::failure::Failure;

/// Where a result is written: to a temporary file beside its place, renamed at the end.
pub(crate) enum Output {
    File {
        path: PathBuf,
        file: BufWriter<NamedTempFile>,
    },
    /// Standard output, a device or a pipe: nothing to rename.
    Stream {
        path: PathBuf,
        stream: Box<dyn Write>,
    },
    /// The same for what is written over before it goes out.
    Spooled {
        path: PathBuf,
        spool: BufWriter<fs::File>,
        stream: Box<dyn Write>,
    },
}

const BUFFER: usize = 1 << 16;

/// Temporary files that have not taken their names.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// Removes the temporary files of all outputs, where the program ends without dropping them.
pub(crate) fn discard_unfinished() {
    for path in UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner).drain(..) {
        // Another thread may just have finished it, or dropped it.
        let _ = fs::remove_file(path);
    }
}

impl Output {
    /// Opens the place `path` names; `-` is standard output.
    pub(crate) fn create(path: &Path) -> Result<Self, Failure> {
        let fail = |e: io::Error| Failure::write(path, &e);
        if path.as_os_str() == "-" {
            return Ok(Self::Stream { path: path.into(), stream: Box::new(io::stdout()) });
        }
        if path.is_dir() {
            return Err(Failure::could_not(format!(
                "{}: could not write: it is a folder",
                path.display()
            )));
        }
        // A link keeps pointing where it points; its target is what is replaced.
        let path = fs::canonicalize(path).unwrap_or_else(|_| path.to_path_buf());
        if path.exists() && !path.is_file() {
            let stream = fs::OpenOptions::new().write(true).open(&path).map_err(fail)?;
            return Ok(Self::Stream { path, stream: Box::new(stream) });
        }
        let folder = folder_of(&path);
        if !folder.is_dir() {
            let (file, folder) = (path.display(), folder.display());
            let message = format!("{file}: could not write: there is no folder {folder}");
            return Err(Failure::could_not(message));
        }
        let mut builder = tempfile::Builder::new();
        builder.prefix(".fgm-").suffix(".part");
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Less the umask, as for any file a program makes.
            builder.permissions(fs::Permissions::from_mode(0o666));
        }
        // Without the temporary name, which would mean nothing to the user.
        let file = builder.tempfile_in(folder).map_err(|e| fail(e.kind().into()))?;
        let mut unfinished = UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner);
        unfinished.push(file.path().to_path_buf());
        drop(unfinished);
        Ok(Self::File { path, file: BufWriter::with_capacity(BUFFER, file) })
    }

    /// As [`create`](Self::create), for what is to be [filled in](Self::fill).
    pub(crate) fn to_fill(path: &Path) -> Result<Self, Failure> {
        match Self::create(path)? {
            Self::Stream { path, stream } => {
                let spool = tempfile::tempfile().map_err(|e| Failure::write(&path, &e))?;
                let spool = BufWriter::with_capacity(BUFFER, spool);
                Ok(Self::Spooled { path, spool, stream })
            }
            output => Ok(output),
        }
    }

    /// Fills in the lines that tell the progress.
    pub(crate) fn fill(&mut self, lines: &ProgressLines) -> Result<(), Failure> {
        match self {
            Self::File { path, file } => lines.fill(file).map_err(|e| Failure::write(path, &e)),
            Self::Spooled { path, spool, .. } => {
                lines.fill(spool).map_err(|e| Failure::write(path, &e))
            }
            // What went out cannot be written over: the lines stay comments.
            Self::Stream { .. } => Ok(()),
        }
    }

    /// Puts the finished file in its place.
    pub(crate) fn finish(self) -> Result<(), Failure> {
        match self {
            Self::File { path, file } => {
                let file = file.into_inner().map_err(|e| Failure::write(&path, e.error()))?;
                file.persist(&path).map_err(|e| Failure::write(&path, &e.error))?;
                Ok(())
            }
            Self::Stream { path, mut stream } => {
                stream.flush().map_err(|e| Failure::write(&path, &e))
            }
            Self::Spooled { path, spool, mut stream } => {
                let copy = || {
                    let mut spool = spool.into_inner().map_err(io::IntoInnerError::into_error)?;
                    spool.rewind()?;
                    io::copy(&mut spool, &mut stream)?;
                    stream.flush()
                };
                copy().map_err(|e| Failure::write(&path, &e))
            }
        }
    }
}

/// The folder that a file lies in.
pub(crate) fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Self::File { file, .. } => file.write(bytes),
            Self::Stream { stream, .. } => stream.write(bytes),
            Self::Spooled { spool, .. } => spool.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::File { file, .. } => file.flush(),
            Self::Stream { stream, .. } => stream.flush(),
            Self::Spooled { spool, .. } => spool.flush(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_appears_only_when_finished() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.gcode");
        let mut output = Output::create(&path).unwrap();
        output.write_all(b"G28\n").unwrap();
        assert!(!path.exists());
        drop(output);
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);
        // Not dropped, as where the program is told to end.
        let mut output = Output::create(&path).unwrap();
        output.write_all(b"G28\n").unwrap();
        discard_unfinished();
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 0);

        let mut output = Output::create(&path).unwrap();
        output.write_all(b"G28\n").unwrap();
        output.finish().unwrap();
        assert_eq!(fs::read_to_string(&path).unwrap(), "G28\n");
    }

    #[test]
    fn a_folder_that_is_not_there_is_an_error() {
        let folder = tempfile::tempdir().unwrap();
        assert!(Output::create(&folder.path().join("no/out.gcode")).is_err());
        assert!(Output::create(folder.path()).is_err());
    }
}
